#include "engine/eval/mesh_metrics.h"

#include <cmath>
#include <random>

#include "engine/eval/mesh_alignment.h"
#include "engine/eval/surface_samples.h"
#include "engine/eval/triangle_tree.h"
#include "tests/support/input_files.h"

using namespace surefield;
using doctest::Approx;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

/// The rectangle from (x0, y0) to (x1, y1) at height z.
TriangleMesh rectangle(float x0, float x1, float y0, float y1, float z) {
  return {{{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}}, {}, {{0, 1, 2}, {0, 2, 3}}};
}

TriangleMesh unit_square(float z) {
  return rectangle(0, 1, 0, 1, z);
}

void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto first = static_cast<uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& t : other.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

/// A box with corners at 0 0 0 and (1, 0.8, 0.6).
TriangleMesh box() {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back(i & 1 ? 1.0f : 0.0f, i & 2 ? 0.8f : 0.0f, i & 4 ? 0.6f : 0.0f);
  }
  for (const auto& f : std::vector<std::array<uint32_t, 4>>{
           {0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}) {
    mesh.triangles.push_back({f[0], f[1], f[2]});
    mesh.triangles.push_back({f[0], f[2], f[3]});
  }
  return mesh;
}

TriangleMesh moved(TriangleMesh mesh, const Isometry3d& motion) {
  for (Vector3f& vertex : mesh.vertices) vertex = (motion * vertex.cast<double>()).cast<float>();
  return mesh;
}

Isometry3d motion(const Vector3d& translation, double angle, const Vector3d& axis) {
  Isometry3d result = Isometry3d::Identity();
  result.translate(translation).rotate(Eigen::AngleAxisd(angle, axis.normalized()));
  return result;
}

/// Looks along z from the origin; 90 degrees wide and high.
Camera camera_at_origin() {
  return {Intrinsics{100, 100, 50, 50, 49.5, 49.5}, Pose::Identity()};
}

}  // namespace

TEST_CASE("surface distances by hand: accuracy, completion, ratio below 5 cm, F1 at 1 cm") {
  const SurfaceDistances d = summarise_distances({0, 0.005, 0.02, 0.035}, {0.001, 0.03, 0.049, 0.051, 0.119});
  CHECK(d.accuracy == Approx(0.015));
  CHECK(d.completion == Approx(0.05));
  CHECK(d.completion_ratio == Approx(0.6));
  CHECK(d.precision == Approx(0.5));
  CHECK(d.recall == Approx(0.2));
  CHECK(d.f1() == Approx(2 * 0.5 * 0.2 / 0.7));
  CHECK(summarise_distances({1}, {1}).f1() == 0);
}

TEST_CASE("two parallel squares are as far apart as they are") {
  const MeshMetrics metrics = compare_meshes(unit_square(0.2f), unit_square(0), {.samples = 5000});
  CHECK(metrics.nearest_triangle.accuracy == Approx(0.2).epsilon(1e-6));
  CHECK(metrics.nearest_triangle.completion == Approx(0.2).epsilon(1e-6));
  CHECK(metrics.nearest_triangle.completion_ratio == 0);
  CHECK(metrics.nearest_triangle.f1() == 0);
  // Between samples there is the way to the side, too: at a density of 5000, 0.007 m on average.
  CHECK(metrics.point_to_point.accuracy > 0.2);
  CHECK(metrics.point_to_point.accuracy < 0.2005);
  CHECK(metrics.area == Approx(1));
  CHECK(metrics.alignment.isApprox(Isometry3d::Identity()));
  CHECK_FALSE(metrics.depth);
}

TEST_CASE("a plane of which half is missing is accurate and incomplete") {
  const MeshMetrics metrics = compare_meshes(rectangle(0, 0.5f, 0, 1, 0), unit_square(0), {.samples = 40000});
  CHECK(metrics.nearest_triangle.accuracy < 1e-7);
  // The distance of what is missing goes from 0 to 0.5.
  CHECK(metrics.nearest_triangle.completion == Approx(0.125).epsilon(0.02));
  CHECK(metrics.nearest_triangle.completion_ratio == Approx(0.55).epsilon(0.02));
  CHECK(metrics.nearest_triangle.precision == 1);
  CHECK(metrics.nearest_triangle.recall == Approx(0.51).epsilon(0.02));
  CHECK(metrics.nearest_triangle.f1() == Approx(2 * 0.51 / 1.51).epsilon(0.02));
  CHECK(metrics.area == Approx(0.5));
}

TEST_CASE("a mesh against itself: no distance to the triangles, the floor of sampling between points") {
  const MeshMetrics metrics = compare_meshes(box(), box(), {.samples = 20000});
  CHECK(metrics.nearest_triangle.accuracy < 1e-7);
  CHECK(metrics.nearest_triangle.completion < 1e-7);
  CHECK(metrics.nearest_triangle.f1() == 1);
  // Points of density n have their nearest neighbour at 0.5 / sqrt(n), on average.
  const double floor = 0.5 / std::sqrt(20000 / surface_area(box()));
  CHECK(metrics.point_to_point.accuracy == Approx(floor).epsilon(0.05));
  CHECK(metrics.point_to_point.completion == Approx(floor).epsilon(0.05));
}

TEST_CASE("the same seed gives the same figures to the last bit") {
  const auto measure = [](uint32_t seed) {
    return compare_meshes(box(), unit_square(0.3f), {.samples = 2000, .seed = seed}).point_to_point.accuracy;
  };
  CHECK(measure(1) == measure(1));
  CHECK(measure(1) != measure(3));
}

TEST_CASE("samples are spread evenly over the area, whatever the triangles") {
  TriangleMesh mesh = rectangle(0, 3, 0, 1, 0);
  append(mesh, rectangle(0, 1, 0, 1, 5));
  CHECK(surface_area(mesh) == Approx(4));
  constexpr std::size_t kCount = 40000;
  std::array<int, 4> cells{};  // of one square metre each
  std::array<int, 4> quarters{};
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& p : sample_surface(mesh, kCount, 7)) {
    ++cells[p.z() > 1 ? 3 : static_cast<std::size_t>(p.x())];
    ++quarters[static_cast<std::size_t>(4 * p.y())];
    mean += p / kCount;
  }
  // A cell's count has a standard deviation of 87.
  for (int count : cells) CHECK(std::abs(count - 10000) < 400);
  for (int count : quarters) CHECK(std::abs(count - 10000) < 400);
  CHECK(mean.y() == Approx(0.5).epsilon(0.02));
}

TEST_CASE("the tree finds the same nearest point as trying all triangles") {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> value(-1, 1);
  TriangleMesh mesh;
  for (uint32_t i = 0; i < 300; ++i) {
    const Vector3f at(value(random), value(random), value(random));
    for (int k = 0; k < 3; ++k) {
      mesh.vertices.push_back(at + 0.2f * Vector3f(value(random), value(random), value(random)));
    }
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  mesh.triangles.push_back({0, 0, 0});  // no area
  const TriangleTree tree(mesh);
  for (int i = 0; i < 200; ++i) {
    const Vector3d point(2 * value(random), value(random), value(random));
    double best = 1e9;
    for (const auto& t : mesh.triangles) {
      const TriangleMesh one{
          {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]}, {}, {{0, 1, 2}}};
      best = std::min(best, TriangleTree(one).nearest(point).distance);
    }
    const SurfacePoint nearest = tree.nearest(point);
    CHECK(nearest.distance == best);
    CHECK((nearest.position - point).norm() == Approx(best));
  }
}

TEST_CASE("the nearest point of a triangle lies inside, on a side or on a corner") {
  const TriangleMesh mesh{{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}, {}, {{0, 1, 2}}};
  const TriangleTree tree(mesh);
  const auto nearest = [&](double x, double y, double z) { return tree.nearest({x, y, z}).position; };
  CHECK(nearest(0.5, 0.5, 3).isApprox(Vector3d(0.5, 0.5, 0)));
  CHECK(nearest(0.5, -1, -1).isApprox(Vector3d(0.5, 0, 0)));
  CHECK(nearest(2, 2, 1).isApprox(Vector3d(1, 1, 0)));
  CHECK(nearest(3, -1, 0).isApprox(Vector3d(2, 0, 0)));
  CHECK(nearest(-1, -1, 5).norm() < 1e-12);
  CHECK(tree.normal(0).isApprox(Vector3d::UnitZ()));
}

TEST_CASE("ICP finds how a box was moved") {
  const TriangleMesh truth = box();
  const Isometry3d away = motion({0.02, -0.03, 0.025}, 0.03, {1, 2, 3});
  const TriangleMesh reconstruction = moved(truth, away);
  const MeshMetrics metrics = compare_meshes(reconstruction, truth, {.samples = 2000});
  CHECK((metrics.alignment * away).isApprox(Isometry3d::Identity(), 1e-4));
  CHECK(metrics.nearest_triangle.accuracy < 1e-5);
  // A start that brings it near is needed where it is far away.
  const Isometry3d far = motion({4, 1, -2}, 2, {0, 1, 1});
  const MeshMetrics found =
      compare_meshes(moved(reconstruction, far), truth, {.start = far.inverse(), .samples = 2000});
  CHECK((found.alignment * far * away).isApprox(Isometry3d::Identity(), 1e-4));
}

TEST_CASE("ICP leaves alone what the surface does not determine, and is not led astray by other surfaces") {
  TriangleMesh reconstruction = rectangle(0.2f, 0.8f, 0.2f, 0.8f, 0.03f);
  append(reconstruction, rectangle(0.2f, 0.8f, 0.2f, 0.4f, 0.5f));
  const TriangleMesh truth = unit_square(0);
  const MeshMetrics metrics = compare_meshes(reconstruction, truth, {.samples = 2000});
  const Isometry3d expected = motion({0, 0, -0.03}, 0, Vector3d::UnitX());
  CHECK(metrics.alignment.isApprox(expected, 1e-6));
}

TEST_CASE("poses align worlds even where the camera moved along a line") {
  const Isometry3d between = motion({1, -2, 0.5}, 1.2, {0.3, 1, -0.4});
  std::vector<PosePair> pairs;
  for (int i = 0; i < 5; ++i) {
    const Isometry3d truth = motion({0.1 * i, 0, 0}, 0.2, Vector3d::UnitY());
    pairs.push_back({0.1 * i, between.inverse() * truth, truth});
  }
  CHECK(align_poses(pairs).isApprox(between, 1e-9));
  CHECK(test::contains(test::input_error([] { align_poses({}); }), "no pose can be paired"));
}

TEST_CASE("the depth of a slanted plane is exact in every pixel, also where it comes behind the camera") {
  // The plane z = 1 + x / 2, from far behind to far before the camera.
  const TriangleMesh mesh{
      {{-9, -20, -3.5f}, {9, -20, 5.5f}, {9, 20, 5.5f}, {-9, 20, -3.5f}}, {}, {{0, 1, 2}, {0, 2, 3}}};
  const Camera camera = camera_at_origin();
  const std::vector<float> depth = render_mesh_depth(mesh, camera);
  for (int v = 0; v < 100; v += 11)
    for (int u = 0; u < 100; u += 7) {
      const double x = (u - 49.5) / 50;
      CHECK(depth[static_cast<std::size_t>(100 * v + u)] == Approx(1 / (1 - 0.5 * x)).epsilon(1e-5));
    }
}

TEST_CASE("what stands behind a wall, or beside the image, is culled") {
  const TriangleMesh wall = rectangle(-1, 1, -1, 1, 2);
  TriangleMesh truth = wall;
  append(truth, rectangle(-1.2f, 1.2f, -1.2f, 1.2f, 3));  // in the shadow of the wall
  append(truth, rectangle(5, 6, -1, 1, 2));               // beside the image
  const MeshViews views(truth, {camera_at_origin()});
  CHECK(views.sees({0, 0, 1}));
  CHECK(views.sees({0, 0, 2.02}));
  CHECK_FALSE(views.sees({0, 0, 2.04}));
  CHECK_FALSE(views.sees({0, 0, -1}));
  CHECK(views.sees({2.4, 0, 2.5}));
  CHECK_FALSE(views.sees({2.6, 0, 2.5}));
  const TriangleMesh visible = views.visible_part(truth);
  CHECK(surface_area(visible) == Approx(4).epsilon(1e-3));
  for (const Vector3f& vertex : visible.vertices) CHECK(vertex.z() == 2);
}

TEST_CASE("culling is done to both meshes before they are compared, and depth is that of the views") {
  const TriangleMesh truth = rectangle(-4, 4, -1, 1, 2);  // the image ends at x = -2 and 2
  TriangleMesh reconstruction = rectangle(-2, 2, -1, 1, 2.2f);
  append(reconstruction, rectangle(-1, 1, -1, 1, 1.5f));
  append(reconstruction, rectangle(-1, 1, -1, 1, 9));  // behind the truth
  MeshComparison comparison{.cameras = {camera_at_origin()}, .samples = 5000};
  const MeshMetrics metrics = compare_meshes(reconstruction, truth, comparison);
  CHECK(metrics.truth_area == Approx(8).epsilon(0.02));
  CHECK(metrics.truth_kept == Approx(0.5).epsilon(0.02));
  CHECK(metrics.area == Approx(4).epsilon(0.02));
  CHECK(metrics.kept == Approx(4.0 / 16).epsilon(0.02));
  CHECK(metrics.nearest_triangle.accuracy == Approx(0.5).epsilon(1e-3));
  REQUIRE(metrics.depth);
  // The truth shows in 50 rows of 100 pixels. The near square covers 66 of each; the far one, 90 x 46, shows
  // beside it.
  CHECK(metrics.depth->shown == Approx((66 * 50 + 24 * 46) / 5000.0));
  CHECK(metrics.depth->mean == Approx((66 * 50 * 0.5 + 24 * 46 * 0.2) / (66 * 50 + 24 * 46)).epsilon(1e-5));
}

TEST_CASE("the depth of two walls differs by the distance between them") {
  const MeshViews views(rectangle(-3, 3, -3, 3, 2), {camera_at_origin()});
  const DepthDifference all = views.compare_depth(rectangle(-3, 3, -3, 3, 2.1f));
  CHECK(all.mean == Approx(0.1).epsilon(1e-5));
  CHECK(all.shown == 1);
  const DepthDifference half = views.compare_depth(rectangle(0, 3, -3, 3, 1.9f));
  CHECK(half.mean == Approx(0.1).epsilon(1e-5));
  CHECK(half.shown == Approx(0.5));
  CHECK(std::isnan(views.compare_depth({}).mean));
}

TEST_CASE("Gaussian centres have their distance to the surface and the surface its distance to them") {
  std::vector<Vector3d> centres;
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j) centres.emplace_back(0.05 + 0.1 * i, 0.05 + 0.1 * j, 0.2 + 0.01 * j);
  const CentreDistances d = compare_centres(centres, unit_square(0), {.samples = 20000});
  CHECK(d.centres == 100);
  CHECK(d.mean == Approx(0.245));
  CHECK(d.median == Approx(0.25));
  // One centre below each sample, up to 0.2 to 0.29 away, and up to 7 cm to the side.
  CHECK(d.to_centres > 0.245);
  CHECK(d.to_centres < 0.255);
  CHECK(d.chamfer() == d.mean + d.to_centres);
}

TEST_CASE("meshes without area cannot be compared, and the error says so") {
  CHECK(test::contains(test::input_error([] { compare_meshes({}, unit_square(0), {}); }), "no area"));
  CHECK(test::contains(test::input_error([] { compare_meshes(unit_square(0), {}, {}); }), "no triangles"));
}
