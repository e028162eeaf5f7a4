#include "engine/synth/scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/synth/places.h"
#include "engine/types/error.h"

namespace surefield {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

struct Place {
  const char* name;
  Scene (*make)(uint32_t seed);
};

constexpr Place kPlaces[] = {{"office", make_office},
                             {"apartment", make_apartment},
                             {"corridor", make_corridor},
                             {"hall", make_hall},
                             {"twins", make_twins}};

}  // namespace

bool Material::is_blank() const {
  return pattern == Pattern::Plain && noise_contrast == 0 && cell_contrast == 0 && cell_hue == 0 &&
         joint == 0;
}

Eigen::Vector3f Material::mean_colour() const {
  // Cells of random hues are a medium grey on average.
  const Eigen::Vector3f base = 0.5f * (first + second);
  return (1 - cell_hue) * base + cell_hue * Eigen::Vector3f::Constant(0.29f);
}

Eigen::Matrix3d Shape::to_unit() const {
  return half_size.cwiseInverse().asDiagonal() * shape_to_world.linear().transpose();
}

double Shape::distance(const Vector3d& point) const {
  const Vector3d local = shape_to_world.inverse() * point;
  return (local.cwiseAbs() - half_size).cwiseMax(0.0).norm();
}

Vector3d Shape::outward_normal(const Vector3d& point) const {
  Vector3d unit = to_unit() * (point - shape_to_world.translation());
  int axis = 0;
  const double largest = unit.cwiseAbs().maxCoeff(&axis);
  const bool cap = kind == ShapeKind::Cylinder && std::abs(unit.z()) > unit.head<2>().norm();
  if (kind == ShapeKind::Box) unit = unit.cwiseProduct(Vector3d::Unit(axis)) / largest;
  if (kind == ShapeKind::Cylinder) unit = cap ? Vector3d(0, 0, unit.z()) : Vector3d(unit.x(), unit.y(), 0);
  return (to_unit().transpose() * unit).normalized();
}

Eigen::Isometry3d MovingObject::pose(double seconds) const {
  double length = 0;
  const auto corner = [&](std::size_t i) { return track[i % track.size()]; };
  for (std::size_t i = 0; i < track.size(); ++i) length += (corner(i + 1) - corner(i)).norm();
  double left = std::fmod(speed * seconds, length);
  std::size_t side = 0;
  while (left > (corner(side + 1) - corner(side)).norm()) {
    left -= (corner(side + 1) - corner(side)).norm();
    ++side;
  }
  const Vector2d along = (corner(side + 1) - corner(side)).normalized();
  const Vector2d at = corner(side) + left * along;
  return Eigen::Translation3d(at.x(), at.y(), 0) *
         Eigen::AngleAxisd(std::atan2(along.y(), along.x()), Vector3d::UnitZ());
}

double Scene::clearance(const Vector3d& point) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Shape& shape : shapes) nearest = std::min(nearest, shape.distance(point));
  return nearest;
}

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const Place& place : kPlaces) names.emplace_back(place.name);
  return names;
}

Scene make_scene(const std::string& name, uint32_t seed) {
  for (const Place& place : kPlaces)
    if (name == place.name) {
      Scene scene = place.make(seed);
      // Boxes first, as SceneRenderer likes it.
      std::stable_partition(scene.shapes.begin(), scene.shapes.end(),
                            [](const Shape& shape) { return shape.kind == ShapeKind::Box; });
      return scene;
    }
  throw InputError(fmt::format("unknown scene \"{}\"; there are: {}", name, fmt::join(scene_names(), ", ")));
}

}  // namespace surefield
