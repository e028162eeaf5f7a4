#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "engine/mesh/depth_sampler.h"
#include "engine/mesh/tsdf_volume.h"
#include "engine/types/error.h"
#include "tests/support/input_files.h"

using namespace surefield;

namespace {

const Intrinsics kLens{160, 120, 140, 140, 79.5, 59.5};

/// The images that a view speaks of.
struct Images {
  Camera camera;
  std::vector<float> depth;
  std::vector<float> colour;

  DepthView view() const { return {camera, depth, colour}; }
};

/// Images of a surface: `depth_along(origin, ray)` is the depth of what the ray hits whose camera z is 1, or
/// 0.
template <typename Surface>
Images take(const Camera& camera, Surface depth_along) {
  Images images{camera, {}, {}};
  const Pose to_world = camera.world_to_camera.inverse();
  const Eigen::Vector3d origin = to_world.translation();
  const Intrinsics& k = camera.intrinsics;
  for (int v = 0; v < k.height; ++v)
    for (int u = 0; u < k.width; ++u) {
      const Eigen::Vector3d ray =
          to_world.linear() * Eigen::Vector3d((u - k.cx) / k.fx, (v - k.cy) / k.fy, 1);
      images.depth.push_back(static_cast<float>(depth_along(origin, ray)));
      images.colour.insert(images.colour.end(), {0.2f, 0.4f, 0.6f});
    }
  return images;
}

/// The plane normal . x = offset.
Images take_plane(const Camera& camera, const Eigen::Vector3d& normal, double offset) {
  return take(camera, [&](const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
    return std::max(0.0, (offset - normal.dot(origin)) / normal.dot(ray));
  });
}

Images facing_wall(double distance) {
  return take_plane({kLens}, Eigen::Vector3d::UnitZ(), distance);
}

/// A sphere around the origin.
Images take_sphere(const Camera& camera, double radius) {
  return take(camera, [&](const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
    const double a = ray.squaredNorm();
    const double b = ray.dot(origin);
    const double root = b * b - a * (origin.squaredNorm() - radius * radius);
    return root < 0 ? 0.0 : (-b - std::sqrt(root)) / a;
  });
}

/// A camera at `position` that looks at the origin.
Camera looking_at_origin(const Eigen::Vector3d& position) {
  const Eigen::Vector3d forward = -position.normalized();
  const Eigen::Vector3d other =
      std::abs(forward.y()) < 0.9 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d right = other.cross(forward).normalized();
  Pose pose = Pose::Identity();
  pose.linear() << right, forward.cross(right), forward;
  pose.translation() = position;
  return {kLens, pose.inverse()};
}

/// The normal of a triangle, twice as long as its area.
Eigen::Vector3d normal_of(const TriangleMesh& mesh, const std::array<uint32_t, 3>& t) {
  const auto corner = [&](std::size_t k) { return mesh.vertices[t[k]].cast<double>().eval(); };
  return (corner(1) - corner(0)).cross(corner(2) - corner(0));
}

double area_of(const TriangleMesh& mesh) {
  double area = 0;
  for (const auto& t : mesh.triangles) area += normal_of(mesh, t).norm() / 2;
  return area;
}

/// The largest distance of the values from `expected`.
template <typename Value>
double worst(const TriangleMesh& mesh, double expected, Value value) {
  double result = 0;
  for (const auto& v : mesh.vertices) {
    result = std::max(result, std::abs(value(v.cast<double>().eval()) - expected));
  }
  return result;
}

double height_of(const Eigen::Vector3d& p) {
  return p.z();
}

}  // namespace

TEST_CASE("nothing integrated gives an empty mesh") {
  CHECK(TsdfVolume().extract().triangles.empty());
  TsdfVolume volume;
  volume.integrate(take({kLens}, [](const auto&, const auto&) { return 0.0; }).view());
  CHECK(volume.blocks() == 0);
  CHECK(volume.extract().vertices.empty());
}

TEST_CASE("an open plane gives one sheet, of the right area, that faces the camera") {
  TsdfVolume volume;
  volume.integrate(facing_wall(1.003).view());
  const TriangleMesh mesh = volume.extract();
  REQUIRE(mesh.triangles.size() > 1000);
  CHECK(worst(mesh, 1.003, height_of) < 1e-4);
  for (const auto& t : mesh.triangles) CHECK(normal_of(mesh, t).z() <= 0);
  // What the image covers, less the margin of at most two voxels on each side where cells are not complete.
  const double width = 160 * 1.003 / 140;
  const double height = 120 * 1.003 / 140;
  CHECK(area_of(mesh) < width * height);
  CHECK(area_of(mesh) > (width - 0.04) * (height - 0.04));
  for (const auto& c : mesh.colours) CHECK((c - Eigen::Vector3f(0.2f, 0.4f, 0.6f)).norm() < 1e-5f);
}

TEST_CASE("a plane seen at a slant is exact too, since inverse depth is interpolated") {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.8, 0.1, 1).normalized();
  TsdfVolume volume;
  volume.integrate(take_plane({kLens}, normal, 0.9).view());
  const TriangleMesh mesh = volume.extract();
  REQUIRE(mesh.triangles.size() > 1000);
  CHECK(worst(mesh, 0.9, [&](const Eigen::Vector3d& p) { return normal.dot(p); }) < 1e-3);
}

TEST_CASE("a sphere seen from all sides is closed, accurate and turned outwards") {
  constexpr double kRadius = 0.5;
  TsdfVolume volume;
  for (int axis = 0; axis < 3; ++axis) {
    for (double side : {-2.0, 2.0}) {
      const Eigen::Vector3d position = side * Eigen::Vector3d::Unit(axis);
      volume.integrate(take_sphere(looking_at_origin(position), kRadius).view());
    }
  }
  const TriangleMesh mesh = volume.extract();
  REQUIRE(mesh.triangles.size() > 10000);
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
    CHECK(normal_of(mesh, t).dot(mesh.vertices[t[0]].cast<double>()) > -1e-8);
  }
  for (const auto& [edge, count] : edges) CHECK(edges.contains({edge.second, edge.first}));
  const auto radius = [](const Eigen::Vector3d& p) { return p.norm(); };
  CHECK(worst(mesh, kRadius, radius) < 0.01);
  double sum = 0;
  for (const auto& v : mesh.vertices) sum += std::abs(v.norm() - kRadius);
  CHECK(sum / static_cast<double>(mesh.vertices.size()) < 0.002);
}

TEST_CASE("noise averages out over views") {
  TsdfVolume volume;
  for (double offset : {-0.01, 0.01, -0.01, 0.01}) volume.integrate(facing_wall(1.003 + offset).view());
  CHECK(worst(volume.extract(), 1.003, height_of) < 1e-3);
}

TEST_CASE("a view from near weighs more than one from far, by the sensor's noise") {
  const DepthNoise noise = noise_of(DepthSensor::StructuredLight);
  Camera behind{kLens};
  behind.world_to_camera.translation().z() = 2;  // it stands two metres farther from the wall
  const auto fused = [&](const DepthNoise& of_views) {
    TsdfVolume volume;
    const Images near_images = facing_wall(1.02),
                 far_images = take_plane(behind, Eigen::Vector3d::UnitZ(), 1);
    DepthView near = near_images.view(), far = far_images.view();
    near.noise = far.noise = of_views;
    volume.integrate(near);
    volume.integrate(far);
    return volume.extract();
  };
  // The mean height of what both see.
  const auto height = [](const TriangleMesh& mesh) {
    double sum = 0;
    int count = 0;
    for (const Eigen::Vector3f& v : mesh.vertices) {
      if (v.head<2>().norm() > 0.2) continue;
      sum += v.z();
      ++count;
    }
    REQUIRE(count > 100);
    return sum / count;
  };
  CHECK(height(fused({.constant = 1})) == doctest::Approx(1.01).epsilon(1e-4));
  const double near = 1 / std::pow(noise.sigma(1.02), 2), far = 1 / std::pow(noise.sigma(3), 2);
  CHECK(height(fused(noise)) == doctest::Approx((near * 1.02 + far) / (near + far)).epsilon(1e-4));
}

TEST_CASE("a surface that later views look through goes away") {
  TsdfVolume volume;
  volume.integrate(facing_wall(1.003).view());
  volume.integrate(facing_wall(2.003).view());
  volume.integrate(facing_wall(2.003).view());
  const TriangleMesh mesh = volume.extract();
  REQUIRE(!mesh.vertices.empty());
  CHECK(worst(mesh, 2.003, height_of) < 1e-3);
}

TEST_CASE("memory grows with the surface and not with the volume before it") {
  // A narrower lens at four times the distance sees the same piece of wall through more air.
  Intrinsics narrow = kLens;
  narrow.fx *= 4;
  narrow.fy *= 4;
  const auto blocks = [](const Intrinsics& lens, double distance) {
    TsdfVolume volume;
    volume.integrate(take_plane({lens}, Eigen::Vector3d::UnitZ(), distance).view());
    CHECK(volume.bytes() > volume.blocks() * 512 * 20);
    return volume.blocks();
  };
  const std::size_t near_wall = blocks(kLens, 1.02);
  CHECK(near_wall > 200);
  CHECK(static_cast<double>(blocks(narrow, 4.06)) < 1.3 * static_cast<double>(near_wall));
  TsdfVolume again;
  for (int i = 0; i < 3; ++i) again.integrate(facing_wall(1.02).view());
  CHECK(again.blocks() == near_wall);
}

TEST_CASE("invalid depth of any kind gives no surface") {
  TsdfVolume volume;
  Images images = facing_wall(1.003);
  const std::array<float, 4> invalid = {0, -1, std::numeric_limits<float>::quiet_NaN(),
                                        std::numeric_limits<float>::infinity()};
  for (std::size_t i = 0; i < images.depth.size(); ++i) {
    if (i % 160 >= 80) images.depth[i] = invalid[i % 4];
  }
  volume.integrate(images.view());
  const TriangleMesh mesh = volume.extract();
  REQUIRE(!mesh.vertices.empty());
  for (const auto& v : mesh.vertices) CHECK(v.x() < 0.01f);
}

TEST_CASE("depth is interpolated on a surface and never across an edge") {
  const Images images{{Intrinsics{4, 2, 1, 1, 0, 0}}, {1, 2, 2.02f, 5, 1, 2, 2.02f, 5}, {}};
  const DepthView view = images.view();
  const DepthSampler sampler(view, 0.1);
  CHECK(sampler.at(1.5, 0.5)->depth == doctest::Approx(2 / (1 / 2.0 + 1 / 2.02)));
  CHECK(sampler.at(0.4, 0.5)->depth == 1);
  CHECK(sampler.at(0.6, 0.5)->depth == 2);
  CHECK(sampler.at(3.4, 1.4)->depth == 5);
  CHECK(sampler.at(1.5, 1.4)->depth == sampler.at(1.5, 0.5)->depth);
  CHECK_FALSE(sampler.at(3.5, 1));
  CHECK_FALSE(sampler.at(-0.6, 1));
}

TEST_CASE("impossible settings and views are refused") {
  CHECK(test::contains(test::input_error([] { TsdfVolume({.voxel = 0}); }), "voxel"));
  CHECK(test::contains(test::input_error([] { TsdfVolume({.voxel = 0.02, .truncation = 0.03}); }),
                       "truncation"));
  TsdfVolume volume;
  Images images = facing_wall(1);
  images.depth.pop_back();
  CHECK_THROWS_AS(volume.integrate(images.view()), UsageError);
  CHECK_THROWS_AS(volume.integrate(facing_wall(1e5).view()), UsageError);
}
