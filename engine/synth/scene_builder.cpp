#include "engine/synth/scene_builder.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace surefield {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

Isometry3d turned(const Vector3d& at, double degrees) {
  return Eigen::Translation3d(at) * Eigen::AngleAxisd(degrees * std::numbers::pi / 180, Vector3d::UnitZ());
}

}  // namespace

SceneBuilder::SceneBuilder(std::string name, uint32_t seed) : random(seed) {
  scene.name = std::move(name);
}

int SceneBuilder::material(const Material& material) {
  scene.materials.push_back(material);
  return static_cast<int>(scene.materials.size()) - 1;
}

void SceneBuilder::begin(const std::string& object, const Spot& spot) {
  scene.objects.push_back(object);
  object_to_world_ = turned(spot.at, spot.turn);
  object_turn_ = spot.turn;
}

Shape& SceneBuilder::add(ShapeKind kind, const Isometry3d& in_object, const Vector3d& half_size,
                         int material) {
  Shape shape;
  shape.kind = kind;
  shape.shape_to_world = object_to_world_ * in_object;
  shape.half_size = half_size;
  shape.texture_origin = shape.shape_to_world.translation();
  shape.material = material;
  shape.object = static_cast<int>(scene.objects.size()) - 1;
  scene.shapes.push_back(shape);
  return scene.shapes.back();
}

void SceneBuilder::box(const Vector3d& bottom, const Vector3d& size, int material, double turn) {
  add(ShapeKind::Box, turned(bottom + Vector3d(0, 0, 0.5 * size.z()), turn), 0.5 * size, material);
}

void SceneBuilder::cylinder(const Vector3d& bottom, double radius, double height, int material) {
  add(ShapeKind::Cylinder, turned(bottom + Vector3d(0, 0, 0.5 * height), 0), {radius, radius, 0.5 * height},
      material);
}

void SceneBuilder::rod(const Vector3d& from, const Vector3d& to, double radius, int material) {
  const Isometry3d frame = Eigen::Translation3d(0.5 * (from + to)) *
                           Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), to - from);
  add(ShapeKind::Cylinder, frame, {radius, radius, 0.5 * (to - from).norm()}, material);
}

void SceneBuilder::ellipsoid(const Vector3d& centre, const Vector3d& half_size, int material) {
  add(ShapeKind::Ellipsoid, turned(centre, 0), half_size, material);
}

void SceneBuilder::leaf(const Vector3d& centre, const Vector3d& half_size, const Vector3d& along,
                        const Vector3d& up, int material) {
  Isometry3d frame = Isometry3d::Identity();
  frame.linear().col(0) = along.normalized();
  frame.linear().col(1) = up.cross(along).normalized();
  frame.linear().col(2) = frame.linear().col(0).cross(frame.linear().col(1));
  frame.translation() = centre;
  add(ShapeKind::Ellipsoid, frame, half_size, material);
}

void SceneBuilder::wall(const Vector3d& low, const Vector3d& high, int material) {
  Shape& shape = add(ShapeKind::Box, turned(0.5 * (low + high), 0), 0.5 * (high - low), material);
  shape.texture_origin = Vector3d::Zero();
}

Spot SceneBuilder::on_top(const Vector3d& local, double turn) const {
  return {object_to_world_ * local, object_turn_ + turn};
}

Eigen::Vector3f linear_colour(uint32_t rgb) {
  const auto channel = [&](int shift) {
    return static_cast<float>(std::pow(((rgb >> shift) & 255) / 255.0, 2.2));
  };
  return {channel(16), channel(8), channel(0)};
}

}  // namespace surefield
