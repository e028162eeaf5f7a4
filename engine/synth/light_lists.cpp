#include "engine/synth/light_lists.h"

#include <algorithm>
#include <cmath>

namespace surefield {

using Eigen::Vector3d;

namespace {

/// A square of cells on one face of the cube; `size` cells along its edges.
struct Patch {
  int face, column, row, size;
};

struct Cone {
  Vector3d axis;  ///< unit length
  double spread;  ///< tangent of the half angle
};

/// The direction through a place of a face, in cells; as cell_of_direction of cast_scene.comp has it.
Vector3d direction(int face, double column, double row) {
  const double cells = glsl::LIGHT_CELLS;
  const double u = 2 * column / cells - 1, v = 2 * row / cells - 1, major = face % 2 == 0 ? 1 : -1;
  if (face / 2 == 0) return {major, u, v};
  if (face / 2 == 1) return {u, major, v};
  return {u, v, major};
}

Cone cone_around(const Patch& patch) {
  const double half = 0.5 * patch.size;
  Cone cone{direction(patch.face, patch.column + half, patch.row + half).normalized(), 0};
  for (const int u : {0, 1}) {
    for (const int v : {0, 1}) {
      const Vector3d corner =
          direction(patch.face, patch.column + u * patch.size, patch.row + v * patch.size);
      cone.spread = std::max(cone.spread, corner.cross(cone.axis).norm() / corner.dot(cone.axis));
    }
  }
  cone.spread += 1e-3;  // for what the device rounds
  return cone;
}

/// How far from `origin` rays within the cone can meet the body's box at the earliest, metres; negative where
/// none can. A lower bound.
double nearest_within(const Shape& shape, const Vector3d& origin, const Cone& cone) {
  const Vector3d from =
      shape.shape_to_world.linear().transpose() * (origin - shape.shape_to_world.translation());
  const Vector3d along = shape.shape_to_world.linear().transpose() * cone.axis;
  const double furthest = from.norm() + shape.half_size.norm();
  double entry = 0, exit = 2 * furthest;
  for (int axis = 0; axis < 3; ++axis) {
    const double reach = shape.half_size[axis] + cone.spread * furthest;
    const double step = std::abs(along[axis]) < 1e-12 ? 1e-12 : along[axis];
    const double a = (-reach - from[axis]) / step, b = (reach - from[axis]) / step;
    entry = std::max(entry, std::min(a, b));
    exit = std::min(exit, std::max(a, b));
  }
  return entry <= exit ? entry : -1;
}

class ListBuilder {
 public:
  ListBuilder(const Scene& scene, LightLists& lists) : scene_(scene), lists_(lists) {}

  void add(std::size_t light) {
    light_ = &scene_.lights[light];
    first_cell_ = light * 6 * glsl::LIGHT_CELLS * glsl::LIGHT_CELLS;
    std::vector<glsl::uint> near;
    for (std::size_t i = 0; i < scene_.shapes.size(); ++i) {
      const Shape& shape = scene_.shapes[i];
      if (shape.casts_shadow && shape.distance(light_->position) < light_->range) {
        near.push_back(static_cast<glsl::uint>(i));
      }
    }
    for (int face = 0; face < 6; ++face) divide({face, 0, 0, glsl::LIGHT_CELLS}, near);
  }

 private:
  /// Quarters the patch until it is one cell, with fewer candidates each time.
  void divide(const Patch& patch, const std::vector<glsl::uint>& candidates) {
    const Cone cone = cone_around(patch);
    std::vector<glsl::uint> left;
    for (const glsl::uint i : candidates)
      if (nearest_within(scene_.shapes[i], light_->position, cone) >= 0) left.push_back(i);
    if (patch.size == 1) return store(patch, cone, left);
    const int half = patch.size / 2;
    for (const int u : {0, half})
      for (const int v : {0, half}) divide({patch.face, patch.column + u, patch.row + v, half}, left);
  }

  void store(const Patch& cell, const Cone& cone, const std::vector<glsl::uint>& found) {
    const auto first = static_cast<std::ptrdiff_t>(lists_.entries.size());
    for (const glsl::uint i : found) {
      const double nearest = nearest_within(scene_.shapes[i], light_->position, cone);
      lists_.entries.push_back({i, static_cast<float>(0.999 * nearest)});  // less what the device rounds
    }
    std::stable_sort(lists_.entries.begin() + first, lists_.entries.end(),
                     [](const auto& a, const auto& b) { return a.nearest < b.nearest; });
    const auto row =
        static_cast<std::size_t>(cell.face) * glsl::LIGHT_CELLS + static_cast<std::size_t>(cell.row);
    lists_.cells[first_cell_ + row * glsl::LIGHT_CELLS + static_cast<std::size_t>(cell.column)] = {
        static_cast<glsl::uint>(first), static_cast<glsl::uint>(found.size())};
  }

  const Scene& scene_;
  LightLists& lists_;
  const Light* light_ = nullptr;
  std::size_t first_cell_ = 0;
};

}  // namespace

LightLists make_light_lists(const Scene& scene) {
  LightLists lists;
  lists.cells.resize(scene.lights.size() * 6 * glsl::LIGHT_CELLS * glsl::LIGHT_CELLS);
  ListBuilder builder(scene, lists);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) builder.add(i);
  return lists;
}

}  // namespace surefield
