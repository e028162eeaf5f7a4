#include "engine/synth/scene_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace surefield {

using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

constexpr double kCell = 0.1;      // metres, along the edges of flat faces
constexpr double kChord = 0.0005;  // metres between a chord and its arc, at most
constexpr int kFewestSegments = 8;

int segments_of_circle(double radius) {
  const double half_angle = std::acos(std::max(0.0, 1 - kChord / std::max(radius, kChord)));
  return std::max(kFewestSegments, static_cast<int>(std::ceil(std::numbers::pi / half_angle)));
}

int cells_along(double length) {
  return std::max(1, static_cast<int>(std::ceil(length / kCell)));
}

class MeshBuilder {
 public:
  TriangleMesh mesh;

  void add(const Shape& shape, const Vector3f& colour) {
    shape_ = &shape;
    colour_ = colour;
    if (shape.kind == ShapeKind::Box) add_box();
    if (shape.kind == ShapeKind::Ellipsoid) add_ellipsoid();
    if (shape.kind == ShapeKind::Cylinder) add_cylinder();
  }

 private:
  uint32_t vertex(const Vector3d& unit) {
    const Vector3d local = unit.cwiseProduct(shape_->half_size);
    mesh.vertices.push_back((shape_->shape_to_world * local).cast<float>());
    mesh.colours.push_back(colour_);
    return static_cast<uint32_t>(mesh.vertices.size()) - 1;
  }

  /// A grid of `columns` x `rows` quads through at(u, v), 0 <= u, v <= 1, with u x v outwards.
  template <typename At>
  void grid(int columns, int rows, At at) {
    const auto first = static_cast<uint32_t>(mesh.vertices.size()),
               width = static_cast<uint32_t>(columns) + 1;
    for (int v = 0; v <= rows; ++v)
      for (int u = 0; u <= columns; ++u)
        vertex(at(static_cast<double>(u) / columns, static_cast<double>(v) / rows));
    for (uint32_t v = 0; v < static_cast<uint32_t>(rows); ++v) {
      for (uint32_t u = 0; u < static_cast<uint32_t>(columns); ++u) {
        const uint32_t a = first + v * width + u, b = a + 1, c = a + width + 1, d = a + width;
        triangle(a, b, c);
        triangle(a, c, d);
      }
    }
  }

  /// Leaves out those that the poles of a ball make of no area.
  void triangle(uint32_t a, uint32_t b, uint32_t c) {
    const Vector3f &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
    if ((q - p).cross(r - p).norm() > 1e-12f) mesh.triangles.push_back({a, b, c});
  }

  void add_box() {
    for (int axis = 0; axis < 3; ++axis) {
      const int first = (axis + 1) % 3, second = (axis + 2) % 3;
      for (const double side : {-1.0, 1.0}) {
        grid(cells_along(2 * shape_->half_size[first]), cells_along(2 * shape_->half_size[second]),
             [&](double u, double v) {
               Vector3d unit;
               unit[axis] = side;
               unit[first] = side * (2 * u - 1);
               unit[second] = 2 * v - 1;
               return unit;
             });
      }
    }
  }

  void add_ellipsoid() {
    const int around = segments_of_circle(shape_->half_size.maxCoeff());
    grid(around, (around + 1) / 2, [](double u, double v) {
      const double turn = 2 * std::numbers::pi * u, up = std::numbers::pi * (v - 0.5);
      return Vector3d(std::cos(turn) * std::cos(up), std::sin(turn) * std::cos(up), std::sin(up));
    });
  }

  void add_cylinder() {
    const int around = segments_of_circle(shape_->half_size.head<2>().maxCoeff());
    const auto on_circle = [](double u, double radius, double z) {
      const double turn = 2 * std::numbers::pi * u;
      return Vector3d(radius * std::cos(turn), radius * std::sin(turn), z);
    };
    grid(around, cells_along(2 * shape_->half_size.z()),
         [&](double u, double v) { return on_circle(u, 1, 2 * v - 1); });
    const int rings = cells_along(shape_->half_size.x());
    grid(around, rings, [&](double u, double v) { return on_circle(u, 1 - v, 1); });
    grid(around, rings, [&](double u, double v) { return on_circle(u, v, -1); });
  }

  const Shape* shape_ = nullptr;
  Vector3f colour_ = Vector3f::Zero();
};

}  // namespace

TriangleMesh make_scene_mesh(const Scene& scene) {
  MeshBuilder builder;
  for (const Shape& shape : scene.shapes) {
    const Vector3f light = scene.materials[static_cast<std::size_t>(shape.material)].mean_colour();
    builder.add(shape, light.cwiseMin(1.0f).array().pow(1 / 2.2f));
  }
  return std::move(builder.mesh);
}

}  // namespace surefield
