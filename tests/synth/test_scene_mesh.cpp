#include "engine/synth/scene_mesh.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace surefield;
using Eigen::Vector3d;

namespace {

/// How far a point of a surface is from the true one, metres, to first order.
double deviation(const Shape& shape, const Vector3d& point) {
  const Vector3d unit = shape.to_unit() * (point - shape.shape_to_world.translation());
  const double radius = shape.half_size.minCoeff();
  if (shape.kind == ShapeKind::Box)
    return std::abs(unit.cwiseAbs().maxCoeff() - 1) * shape.half_size.maxCoeff();
  if (shape.kind == ShapeKind::Ellipsoid) return std::abs(unit.norm() - 1) * radius;
  const double side = std::abs(unit.head<2>().norm() - 1) * shape.half_size.x();
  return std::min(side, std::abs(std::abs(unit.z()) - 1) * shape.half_size.z());
}

Scene one(ShapeKind kind, const Vector3d& half_size) {
  Scene scene;
  scene.materials.emplace_back();
  scene.shapes.emplace_back();
  scene.shapes[0].kind = kind;
  scene.shapes[0].half_size = half_size;
  scene.shapes[0].shape_to_world =
      Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.8, Vector3d(1, 2, -1).normalized());
  return scene;
}

struct Measures {
  double area = 0, volume = 0, worst = 0;
};

Measures measure(const TriangleMesh& mesh, const Shape& shape) {
  Measures m;
  const Vector3d centre = shape.shape_to_world.translation();
  for (const auto& triangle : mesh.triangles) {
    const Vector3d a = mesh.vertices[triangle[0]].cast<double>(),
                   b = mesh.vertices[triangle[1]].cast<double>(),
                   c = mesh.vertices[triangle[2]].cast<double>();
    m.area += 0.5 * (b - a).cross(c - a).norm();
    m.volume += (a - centre).cross(b - centre).dot(c - centre) / 6;  // positive where seen counter-clockwise
    m.worst = std::max(m.worst, deviation(shape, (a + b + c) / 3));
  }
  return m;
}

}  // namespace

TEST_CASE(
    "the mesh of each kind of body has its area and volume, faces outwards and is off by less than 1 mm") {
  const double pi = std::acos(-1);
  struct Expected {
    ShapeKind kind;
    Vector3d half_size;
    double area, volume;
  };
  for (const Expected& e :
       {Expected{ShapeKind::Box, {0.5, 0.3, 0.01}, 8 * (0.15 + 0.005 + 0.003), 8 * 0.0015},
        Expected{ShapeKind::Ellipsoid, {0.4, 0.4, 0.4}, 4 * pi * 0.16, 4 / 3.0 * pi * 0.064},
        Expected{
            ShapeKind::Cylinder, {0.3, 0.3, 0.6}, 2 * pi * 0.3 * 1.2 + 2 * pi * 0.09, pi * 0.09 * 1.2}}) {
    CAPTURE(static_cast<int>(e.kind));
    const Scene scene = one(e.kind, e.half_size);
    const Measures m = measure(make_scene_mesh(scene), scene.shapes[0]);
    CHECK(m.area == doctest::Approx(e.area).epsilon(0.01));
    CHECK(m.volume == doctest::Approx(e.volume).epsilon(0.01));
    CHECK(m.worst < 0.001);
  }
}

TEST_CASE("flat faces are cut into small triangles, and every vertex has a colour") {
  const TriangleMesh mesh = make_scene_mesh(one(ShapeKind::Box, {2, 0.05, 1}));
  CHECK(mesh.colours.size() == mesh.vertices.size());
  for (const auto& triangle : mesh.triangles)
    for (int i = 0; i < 3; ++i)
      REQUIRE((mesh.vertices[triangle[i]] - mesh.vertices[triangle[(i + 1) % 3]]).norm() < 0.15f);
}
