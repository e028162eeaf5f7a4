#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "engine/synth/camera_path.h"
#include "engine/synth/random.h"
#include "engine/synth/scene_renderer.h"
#include "engine/types/error.h"
#include "shaders/shared/synth_types.h"
#include "tests/support/device.h"
#include "tests/synth/reference_caster.h"

using namespace surefield;
using namespace surefield::testing;
using Eigen::Vector3d;

namespace {

constexpr Intrinsics kSmall{80, 60, 68, 68, 39.5, 29.5};

/// A camera at the origin that looks along +y with z up.
Camera at_origin(const Intrinsics& intrinsics = kSmall) {
  Camera camera{intrinsics, Pose::Identity()};
  camera.world_to_camera.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return camera;
}

/// A body in front of at_origin(), turned at random.
Shape random_shape(ShapeKind kind, RandomStream& random, double smallest) {
  Shape shape;
  shape.kind = kind;
  const Vector3d axis(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  shape.shape_to_world =
      Eigen::Translation3d(random.uniform(-1, 1), random.uniform(2, 5), random.uniform(-1, 1)) *
      Eigen::AngleAxisd(random.uniform(0, 6), axis.normalized());
  for (int i = 0; i < 3; ++i) shape.half_size[i] = random.uniform(smallest, 0.6);
  if (kind == ShapeKind::Cylinder) shape.half_size[1] = shape.half_size[0];
  shape.texture_origin = shape.shape_to_world.translation();
  return shape;
}

Shape box_at(const Vector3d& centre, const Vector3d& half_size) {
  Shape box;
  box.half_size = half_size;
  box.shape_to_world.translation() = centre;
  return box;
}

Scene scene_of(std::vector<Shape> shapes) {
  Scene scene;
  scene.name = "test";
  scene.materials.emplace_back();
  scene.materials[0].first = scene.materials[0].second = Eigen::Vector3f::Constant(0.5f);
  scene.shapes = std::move(shapes);
  return scene;
}

struct Comparison {
  int hits = 0;   ///< pixels with a surface
  int edges = 0;  ///< pixels left out, as an edge lies within a hundredth of a pixel
  int wrong = 0;  ///< pixels that differ by more than float precision allows, or show another body
};

/// Pixel by pixel, every `step`-th in both directions.
Comparison compare(const Scene& scene, const Camera& camera, int step = 1) {
  const SceneImages images = SceneRenderer(device(), scene).render(camera);
  const Vector3d origin = camera.world_to_camera.inverse().translation();
  Comparison result;
  for (int v = 0; v < camera.intrinsics.height; v += step) {
    for (int u = 0; u < camera.intrinsics.width; u += step) {
      const ReferenceHit truth = reference_cast(scene, origin, pixel_ray(camera, u, v));
      bool edge = false;
      for (const double off : {-0.01, 0.01}) {
        const ReferenceHit a = reference_cast(scene, origin, pixel_ray(camera, u + off, v + 0.6 * off));
        const ReferenceHit b = reference_cast(scene, origin, pixel_ray(camera, u + 0.6 * off, v - off));
        edge = edge || a.shape != truth.shape || b.shape != truth.shape;
      }
      if (edge) {
        ++result.edges;
        continue;
      }
      if (truth.shape >= 0) ++result.hits;
      const double depth = images.depth.at<float>(v, u), expected = truth.shape < 0 ? 0 : truth.depth;
      const bool same = images.shapes.at<int>(v, u) == truth.shape && std::abs(depth - expected) < 1e-4;
      if (!same) ++result.wrong;
    }
  }
  return result;
}

/// What cast_scene.comp makes of light, as 8 bits.
double developed(double light) {
  return 255 * std::pow(1 - std::exp(-light), 1 / 2.2);
}

}  // namespace

TEST_CASE("depth of each kind of body equals that of the double-precision caster") {
  for (const ShapeKind kind : {ShapeKind::Box, ShapeKind::Ellipsoid, ShapeKind::Cylinder}) {
    CAPTURE(static_cast<int>(kind));
    RandomStream random(3);
    std::vector<Shape> shapes;
    for (int i = 0; i < 12; ++i) shapes.push_back(random_shape(kind, random, 0.1));
    const Comparison result = compare(scene_of(shapes), at_origin());
    CHECK(result.hits > 1000);
    CHECK(result.edges < 300);
    CHECK(result.wrong == 0);
  }
}

TEST_CASE("thin stems and leaves keep their depth") {
  for (const ShapeKind kind : {ShapeKind::Ellipsoid, ShapeKind::Cylinder}) {
    Shape thin;
    thin.kind = kind;
    thin.shape_to_world = Eigen::Translation3d(0, 4, 0) * Eigen::AngleAxisd(0.7, Vector3d::UnitY());
    thin.half_size = kind == ShapeKind::Cylinder ? Vector3d(0.003, 0.003, 0.8) : Vector3d(0.5, 0.3, 0.001);
    const Comparison result = compare(scene_of({thin}), at_origin({400, 300, 1600, 1600, 199.5, 149.5}));
    CHECK(result.hits > 100);
    CHECK(result.wrong == 0);
  }
}

TEST_CASE("depth of whole scenes equals that of the double-precision caster") {
  for (const std::string& name : scene_names()) {
    CAPTURE(name);
    const Scene scene = make_scene(name, 2);
    const CameraPath path(scene, path_style("handheld"), 2, 10);
    for (const double seconds : {1.0, 6.0}) {
      const Comparison result =
          compare(scene, {{160, 120, 136, 136, 79.5, 59.5}, path.world_to_camera(seconds)}, 5);
      CHECK(result.hits > 500);
      CHECK(result.wrong == 0);
    }
  }
}

TEST_CASE("depth of a slanted view of a plane is camera z, not the length of the ray") {
  const Shape wall = box_at({0, 2.5, 0}, {50, 0.5, 50});
  Camera camera = at_origin();
  const double pitch = 0.5;
  camera.world_to_camera.linear() =
      Eigen::AngleAxisd(pitch, Vector3d::UnitX()) * camera.world_to_camera.linear();
  const SceneImages images = SceneRenderer(device(), scene_of({wall})).render(camera);
  for (const int v : {0, 30, 59}) {
    // The ray of that row goes forwards by this much for each metre of camera z.
    const double forwards = std::cos(pitch) - (v - kSmall.cy) / kSmall.fy * std::sin(pitch);
    CHECK(images.depth.at<float>(v, 7) == doctest::Approx(2 / forwards).epsilon(1e-6));
  }
}

TEST_CASE("a lamp lights by Lambert's law, and not what lies in the shadow") {
  const Shape floor = box_at({0, 0, -1.5}, {20, 20, 0.5});
  const Shape blocker = box_at({1, 4, 0}, {0.2, 0.2, 0.01});
  Scene scene = scene_of({floor, blocker});
  scene.lights.push_back({{1, 4, 1}, {2, 2, 2}, 10});
  const Camera camera = at_origin({160, 120, 100, 100, 79.5, 59.5});
  const SceneImages images = SceneRenderer(device(), scene).render(camera);
  const auto seen_at = [&](const Vector3d& point) {
    const Vector3d c = camera.world_to_camera * point;
    const int u = cvRound(100 * c.x() / c.z() + 79.5), v = cvRound(100 * c.y() / c.z() + 59.5);
    REQUIRE(images.shapes.at<int>(v, u) == 0);
    return static_cast<double>(images.colour.at<cv::Vec3b>(v, u)[0]);
  };
  const double ambient = 0.26 + 0.09;
  for (const double x : {-1.0, 0.0, 2.5}) {
    const double away = std::hypot(x - 1, 2.0), ratio = away / 10;
    const double strength = std::pow(1 - ratio * ratio, 2) / (1 + 0.35 * away * away);
    CHECK(std::abs(seen_at({x, 4, -1}) - developed(0.5 * (ambient + 2 * strength * 2 / away))) < 2.5);
  }
  CHECK(std::abs(seen_at({1.1, 4, -1}) - developed(0.5 * ambient)) < 1.5);  // in the blocker's shadow
  CHECK(seen_at({1.1, 4, -1}) < seen_at({0, 4, -1}) - 40);
}

TEST_CASE("a glossy floor shows the lamp where it mirrors it") {
  const Shape floor = box_at({0, 0, -1.5}, {20, 20, 0.5});
  Scene scene = scene_of({floor});
  scene.lights.push_back({{0, 6, 1}, {1, 1, 1}, 20});
  const Camera camera = at_origin({80, 80, 68, 68, 39.5, 29.5});
  const SceneImages plain = SceneRenderer(device(), scene).render(camera);
  scene.materials[0].gloss = 1;
  scene.materials[0].shininess = 60;
  const SceneImages glossy = SceneRenderer(device(), scene).render(camera);
  // Camera and mirror point: 1 m above the floor, and the lamp 2 m: the mirror point is a third of the way.
  const int row = cvRound(kSmall.cy + kSmall.fy * 1.0 / 2.0);
  const int here = glossy.colour.at<cv::Vec3b>(row, 40)[0] - plain.colour.at<cv::Vec3b>(row, 40)[0];
  const int aside = glossy.colour.at<cv::Vec3b>(row, 79)[0] - plain.colour.at<cv::Vec3b>(row, 79)[0];
  CHECK(here > 15);
  CHECK(aside < here / 3);
}

TEST_CASE("the same camera gives the same bits, another seed of the scene another picture") {
  const Scene scene = make_scene("office", 3);
  const CameraPath path(scene, path_style("handheld"), 3, 1);
  const Camera camera{kSmall, path.world_to_camera(0.5)};
  const SceneImages first = SceneRenderer(device(), scene).render(camera);
  const SceneImages again = SceneRenderer(pool_device(), scene).render(camera);
  CHECK(cv::norm(first.colour, again.colour, cv::NORM_INF) == 0);
  CHECK(cv::norm(first.depth, again.depth, cv::NORM_INF) == 0);
  const SceneImages other = SceneRenderer(device(), make_scene("office", 4)).render(camera);
  CHECK(cv::norm(first.colour, other.colour, cv::NORM_INF) > 0);
}

TEST_CASE("a scene of too many bodies is refused") {
  CHECK_THROWS_AS(SceneRenderer(device(), scene_of(std::vector<Shape>(glsl::SCENE_SHAPES + 1))), InputError);
}
