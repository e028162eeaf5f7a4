#include "engine/viewer/pick.h"

#include <doctest/doctest.h>

#include <cmath>

#include "engine/viewer/view_painter.h"
#include "tests/reference/scenes.h"
#include "tests/reference/splatting.h"
#include "tests/support/device.h"

using namespace surefield;
using reference::SceneKind;

namespace {

/// The images of a map that is a wall at z = 2, seen by the camera of keyframe_scene().
RenderImages wall(const Camera& camera) {
  const auto pixels = static_cast<std::size_t>(camera.intrinsics.width) * camera.intrinsics.height;
  RenderImages images{.width = camera.intrinsics.width, .height = camera.intrinsics.height};
  images.depth_median.assign(pixels, 2);
  images.dominator.assign(pixels, 0);
  return images;
}

GaussianCloud one_gaussian() {
  GaussianCloud map;
  map.resize(1);
  map.means[0] = {0, 0, 2};
  map.log_scales[0] = {std::log(0.1f), std::log(0.2f), std::log(0.01f)};
  return map;
}

const Camera kCamera{{.width = 100, .height = 80, .fx = 90, .fy = 90, .cx = 49.5, .cy = 39.5}};

/// Keyframes that look along z: at the origin, a metre before it, and far aside.
ViewerScene keyframe_scene() {
  ViewerScene scene;
  scene.frame.camera = kCamera;
  for (const Eigen::Vector3d& place :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(9, 0, 0)}) {
    StampedPose pose;
    pose.camera_to_world.translation() = place;
    scene.keyframes.push_back(pose);
  }
  return scene;
}

}  // namespace

TEST_CASE("what is picked is what the definitions of median depth and dominator give") {
  std::size_t picked = 0, missed = 0;
  for (SceneKind kind :
       {SceneKind::mixed, SceneKind::anisotropic, SceneKind::high_opacity, SceneKind::low_opacity}) {
    reference::Scene scene = reference::random_scene(11, 90, {.kind = kind});
    for (std::size_t i = 0; i < scene.cloud.size(); ++i)
      scene.cloud.uncertainty[i] = 0.001f * static_cast<float>(i);
    const reference::Gaussians gaussians(scene.cloud);
    const reference::Images want = reference::render(gaussians, scene.camera, {});
    ViewPainter painter(testing::device());
    painter.assign(scene.cloud);
    const RenderImages images = painter.measure(scene.camera);
    const Intrinsics& k = scene.camera.intrinsics;
    for (int v = 0; v < k.height; ++v)
      for (int u = 0; u < k.width; ++u) {
        const auto at = static_cast<std::size_t>(v) * k.width + u;
        if (want.on_edge[at]) continue;
        const auto got = pick(images, scene.camera, scene.cloud, {u, v});
        CHECK(got.has_value() == (want.depth_median[at] > 0));
        (got ? picked : missed) += 1;
        if (!got) continue;
        CHECK(got->depth == doctest::Approx(want.depth_median[at]).epsilon(1e-4));
        CHECK(got->gaussian == want.dominator[at]);
        // The point lies on the pixel's ray, at that depth.
        const Eigen::Vector3d p = scene.camera.world_to_camera * got->point;
        CHECK(p.z() == doctest::Approx(got->depth));
        CHECK(k.fx * p.x() / p.z() + k.cx == doctest::Approx(u).epsilon(1e-6));
        CHECK(k.fy * p.y() / p.z() + k.cy == doctest::Approx(v).epsilon(1e-6));
        // The normal is the direction in which the Gaussian is thinnest, to the viewer.
        const auto g = static_cast<std::size_t>(got->gaussian);
        const Eigen::Vector4d q = gaussians.rotations[g].normalized();
        const Eigen::Matrix3d axes = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
        const Eigen::Matrix3d covariance =
            axes * (2 * gaussians.log_scales[g]).array().exp().matrix().asDiagonal() * axes.transpose();
        const double least = std::exp(2 * gaussians.log_scales[g].minCoeff());
        CHECK(got->normal.norm() == doctest::Approx(1));
        CHECK((covariance * got->normal - least * got->normal).norm() < 1e-6 * covariance.norm());
        CHECK((scene.camera.world_to_camera.linear() * got->normal).dot(p) <= 0);
        CHECK(got->sigma.has_value() == (g > 0));
        if (got->sigma) CHECK(*got->sigma == doctest::Approx(std::sqrt(0.001 * static_cast<double>(g))));
      }
  }
  CHECK(picked > 500);
  CHECK(missed > 500);
}

TEST_CASE("picking leaves the picture that was painted before as it is") {
  const auto scene = reference::random_scene(3, 200);
  ViewPainter painter(testing::device());
  painter.assign(scene.cloud);
  Camera half = scene.camera;
  half.intrinsics = half.intrinsics.scaled(0.5);
  painter.paint(half, {.mode = ViewMode::Ellipsoids});
  const cv::Mat before = painter.picture();
  CHECK(painter.measure(scene.camera).width == scene.camera.intrinsics.width);
  CHECK(cv::norm(before, painter.picture(), cv::NORM_INF) == 0);
}

TEST_CASE("beside the picture there is nothing to pick") {
  const RenderImages images = wall(kCamera);
  CHECK(pick(images, kCamera, one_gaussian(), {99, 79}));
  for (const Eigen::Vector2i& pixel :
       {Eigen::Vector2i(-1, 5), Eigen::Vector2i(100, 5), Eigen::Vector2i(5, -1), Eigen::Vector2i(5, 80)})
    CHECK_FALSE(pick(images, kCamera, one_gaussian(), pixel));
}

TEST_CASE(
    "the keyframe of a place is the one whose frustum is there, else the one that saw it from nearest") {
  const ViewerScene scene = keyframe_scene();
  // From the right: the optical axes of the keyframes go to the left of this picture.
  Camera side = kCamera;
  Pose side_to_world = Pose::Identity();
  side_to_world.linear() << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  side_to_world.translation() = Eigen::Vector3d(3, 0, 0.5);
  side.world_to_camera = side_to_world.inverse();
  const auto place_of = [&](const Eigen::Vector3d& point) -> Eigen::Vector2d {
    const Eigen::Vector3d p = side.world_to_camera * point;
    return {90 * p.x() / p.z() + 49.5, 90 * p.y() / p.z() + 39.5};
  };
  const OverlayChoice choice;
  for (int i : {0, 1}) {
    const auto found = keyframe_under(scene, choice, side, {}, place_of({0, 0, double(i)}), 3);
    REQUIRE(found);
    CHECK(found->index == i);
    CHECK(found->pointed);
  }
  const Eigen::Vector2d first = place_of({0, 0, 0});
  CHECK_FALSE(keyframe_under(scene, choice, side, {}, first + Eigen::Vector2d(0, 12), 3));
  CHECK_FALSE(keyframe_under(scene, {.keyframes = false}, side, {}, first, 3));

  // A surface between the camera and the frustum hides it, unless lines are on top.
  Pick surface{.point = {2, 0, 0}, .depth = 1};
  CHECK_FALSE(keyframe_under(scene, choice, side, surface, first, 3));
  CHECK(keyframe_under(scene, {.on_top = true}, side, surface, first, 3));
  // Both keyframes on the axis see this, the second from nearer; neither sees what lies before the first.
  surface = {.point = {0, 0, 4}, .depth = 1};
  const auto seeing = keyframe_under(scene, choice, side, surface, {1, 1}, 3);
  REQUIRE(seeing);
  CHECK(seeing->index == 1);
  CHECK_FALSE(seeing->pointed);
  surface.point = {0, 0, 0.5};
  CHECK(keyframe_under(scene, choice, side, surface, {1, 1}, 3)->index == 0);
  surface.point = {0, 0, -1};
  CHECK_FALSE(keyframe_under(scene, choice, side, surface, {1, 1}, 3));
}

TEST_CASE("what is under the cursor and distances are lines that programs can read") {
  CHECK(describe({}) == "nothing");
  Under under{.surface = Pick{
                  .pixel = {3, 4}, .point = {1, 2, 3}, .depth = 2.5, .normal = {0, 0, -1}, .gaussian = 7}};
  CHECK(describe(under) ==
        "pixel=3,4 point=1.0000,2.0000,3.0000 depth=2.5000 normal=0.0000,0.0000,-1.0000 gaussian=7");
  under.surface->sigma = 0.0123;
  under.keyframe = PickedKeyframe{2, true};
  CHECK(describe(under) ==
        "pixel=3,4 point=1.0000,2.0000,3.0000 depth=2.5000 sigma=0.0123 normal=0.0000,0.0000,-1.0000 "
        "gaussian=7 "
        "keyframe=2 pointed");
  Trajectory keyframes(3);
  keyframes[2].timestamp = 105.5;
  CHECK(tell(under, keyframes, 100) ==
        std::vector<std::string>{"at 1.000, 2.000, 3.000 m", "depth 2.50 m \u00b1 1.23 cm",
                                 "normal 0.00, 0.00, -1.00", "Gaussian 7", "keyframe 2 at 5.50 s"});
  CHECK(tell({}, keyframes, 100) == std::vector<std::string>{"nothing"});
  CHECK(describe({.keyframe = PickedKeyframe{5, false}}) == "keyframe=5");
  const Pick from{.point = {0, 0, 1}}, to{.point = {0.3, 0.4, 1}};
  CHECK(describe_distance(from, to) == "distance=0.5000 from=0.0000,0.0000,1.0000 to=0.3000,0.4000,1.0000");
}

TEST_CASE("marks have a size on the picture, a ruler a line between its ends") {
  const auto near = pick(wall(kCamera), kCamera, one_gaussian(), {20, 30});
  const auto far = pick(wall(kCamera), kCamera, one_gaussian(), {70, 30});
  std::vector<Line> lines;
  add_mark(lines, *near, kCamera, 12);
  auto segments = project_lines(lines, kCamera);
  REQUIRE(segments.size() == 2);
  CHECK(segments[0].from.x == doctest::Approx(14));
  CHECK(segments[0].to.x == doctest::Approx(26));
  CHECK(segments[1].from.y == doctest::Approx(24));
  lines.clear();
  add_ruler(lines, std::vector<Pick>{*near}, kCamera);
  CHECK(lines.size() == 2);
  lines.clear();
  add_ruler(lines, std::vector<Pick>{*near, *far}, kCamera);
  REQUIRE(lines.size() == 5);
  segments = project_lines(std::span(lines).last(1), kCamera);
  CHECK(segments[0].from.x == doctest::Approx(20));
  CHECK(segments[0].to.x == doctest::Approx(70));
  CHECK((lines.back().to - lines.back().from).norm() == doctest::Approx(2.0 * 50 / 90));
  lines.clear();
  add_normal(lines, *near, kCamera, 30);
  REQUIRE(lines.size() == 1);
  CHECK((lines[0].to - lines[0].from).normalized().isApprox(Eigen::Vector3f(0, 0, -1)));
}
