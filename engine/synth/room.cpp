#include "engine/synth/room.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/core/utility.hpp>

namespace surefield {

using Eigen::Vector2d;
using Eigen::Vector2f;
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {

constexpr double kPi = std::numbers::pi;
const Vector3d kLamp(2.2, 2.5, 2.55);
constexpr float kAmbient = 0.45f;

/// The coordinates of a point on a box's face across `axis`, as texture coordinates with v vertical on the
/// sides.
Vector2f face_uv(const Vector3d& point, int axis) {
  if (axis == 2) return point.head<2>().cast<float>();
  return Vector2d(point[1 - axis], point.z()).cast<float>();
}

}  // namespace

Pose SyntheticRoom::world_to_camera(double seconds) const {
  const double start = 2 * kPi * lattice_noise(0, 0, seed_);
  const double turn = start + 0.24 * seconds;
  const auto sway = [&](double hertz, double phase) { return std::sin(2 * kPi * hertz * seconds + phase); };

  Vector3d position = 0.5 * size() + Vector3d(1.4 * std::cos(turn), 1.1 * std::sin(turn), 0.1);
  position +=
      Vector3d(0.010 * sway(0.9, 0.3), 0.010 * sway(0.7, 1.9), 0.06 * sway(0.23, 0.8) + 0.006 * sway(1.7, 0));
  const double yaw = turn + kPi + 0.15 * sway(0.13, 0.5) + 0.012 * sway(1.1, 2.2);
  const double pitch = -0.28 + 0.10 * sway(0.17, 1.0) + 0.010 * sway(1.3, 0.7);
  const double roll = 0.03 * sway(0.31, 0.4) + 0.006 * sway(1.5, 1.1);

  const Vector3d forward(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw), std::sin(pitch));
  const Vector3d right = forward.cross(Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d level;
  level << right.transpose(), forward.cross(right).transpose(), forward.transpose();
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(roll, Vector3d::UnitZ()) * level;
  pose.translation() = -(pose.linear() * position);
  return pose;
}

void SyntheticRoom::hit_walls(const Vector3d& origin, const Vector3d& direction,
                              SurfacePoint* nearest) const {
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) continue;
    const bool high = direction[axis] > 0;
    const double distance = ((high ? size()[axis] : 0.0) - origin[axis]) / direction[axis];
    if (distance >= nearest->distance) continue;
    nearest->distance = distance;
    nearest->normal = Vector3d::Unit(axis) * (high ? -1 : 1);
    nearest->uv = face_uv(origin + distance * direction, axis);
    nearest->material = &walls_[2 * axis + (high ? 1 : 0)];
  }
}

void SyntheticRoom::hit_box(const Box& box, const Vector3d& origin, const Vector3d& direction,
                            SurfacePoint* nearest) {
  const auto to_box = [&](const Vector3d& v) {
    return Vector3d(box.cos_yaw * v.x() + box.sin_yaw * v.y(), box.cos_yaw * v.y() - box.sin_yaw * v.x(),
                    v.z());
  };
  const Vector3d from = to_box(origin - box.centre), along = to_box(direction);
  // A zero component divides to infinities of the right signs, which the comparisons below handle.
  const Vector3d inverse = along.cwiseInverse();
  const Vector3d low = (-box.half_size - from).cwiseProduct(inverse);
  const Vector3d high = (box.half_size - from).cwiseProduct(inverse);
  int axis = 0;
  const double entry = low.cwiseMin(high).maxCoeff(&axis);
  const double exit = low.cwiseMax(high).minCoeff();
  if (!(entry > 0 && entry <= exit && entry < nearest->distance)) return;

  const double side = along[axis] > 0 ? -1 : 1;
  const Vector3d normal = side * Vector3d::Unit(axis);
  nearest->distance = entry;
  nearest->normal = Vector3d(box.cos_yaw * normal.x() - box.sin_yaw * normal.y(),
                             box.sin_yaw * normal.x() + box.cos_yaw * normal.y(), normal.z());
  // Opposite faces get different parts of the pattern.
  nearest->uv =
      face_uv(from + entry * along, axis) + Vector2f::Constant(static_cast<float>(7.3 * side * (axis + 1)));
  nearest->material = &box.material;
}

void SyntheticRoom::hit_sphere(const Sphere& sphere, const Vector3d& origin, const Vector3d& direction,
                               SurfacePoint* nearest) {
  const Vector3d from = origin - sphere.centre;
  const double a = direction.squaredNorm(), b = from.dot(direction);
  const double discriminant = b * b - a * (from.squaredNorm() - sphere.radius * sphere.radius);
  if (discriminant < 0) return;
  const double distance = (-b - std::sqrt(discriminant)) / a;
  if (distance <= 0 || distance >= nearest->distance) return;
  nearest->distance = distance;
  nearest->normal = (from + distance * direction) / sphere.radius;
  nearest->uv = Vector2d(sphere.radius * std::atan2(nearest->normal.y(), nearest->normal.x()),
                         sphere.radius * std::asin(std::clamp(nearest->normal.z(), -1.0, 1.0)))
                    .cast<float>();
  nearest->material = &sphere.material;
}

SurfacePoint SyntheticRoom::cast(const Vector3d& origin, const Vector3d& direction) const {
  SurfacePoint nearest;
  nearest.distance = std::numeric_limits<double>::infinity();
  hit_walls(origin, direction, &nearest);
  for (const Box& box : boxes_) hit_box(box, origin, direction, &nearest);
  for (const Sphere& sphere : spheres_) hit_sphere(sphere, origin, direction, &nearest);
  return nearest;
}

Vector3f SyntheticRoom::shade(const Vector3d& origin, const Vector3d& direction) const {
  const SurfacePoint surface = cast(origin, direction);
  const Vector3d point = origin + surface.distance * direction + 1e-6 * surface.normal;
  const Vector3d to_lamp = kLamp - point;
  float light = kAmbient;
  const double cosine = surface.normal.dot(to_lamp.normalized());
  if (cosine > 0 && cast(point, to_lamp).distance >= 1) light += (1 - kAmbient) * static_cast<float>(cosine);
  return light * texture(*surface.material, surface.uv);
}

Frame SyntheticRoom::render(const Camera& camera) const {
  const Intrinsics& k = camera.intrinsics;
  const Pose to_world = camera.world_to_camera.inverse();
  const Vector3d origin = to_world.translation();
  // Directions have camera z = 1, so that the distance along a ray is the depth.
  const auto ray = [&](double u, double v) {
    return Vector3d(to_world.linear() * Vector3d((u - k.cx) / k.fx, (v - k.cy) / k.fy, 1));
  };
  Frame frame;
  frame.colour.create(k.height, k.width, CV_8UC3);
  frame.depth.create(k.height, k.width, CV_32FC1);
  cv::parallel_for_(cv::Range(0, k.height), [&](const cv::Range& rows) {
    for (int v = rows.start; v < rows.end; ++v) {
      for (int u = 0; u < k.width; ++u) {
        frame.depth.at<float>(v, u) = static_cast<float>(cast(origin, ray(u, v)).distance);
        Vector3f sum = Vector3f::Zero();
        for (const double dv : {-0.25, 0.25}) {
          for (const double du : {-0.25, 0.25}) sum += shade(origin, ray(u + du, v + dv));
        }
        for (int c = 0; c < 3; ++c) {
          frame.colour.at<cv::Vec3b>(v, u)[c] = cv::saturate_cast<uchar>(0.25f * 255 * sum[c]);
        }
      }
    }
  });
  return frame;
}

}  // namespace surefield
