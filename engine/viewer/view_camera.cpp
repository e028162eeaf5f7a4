#include "engine/viewer/view_camera.h"

#include <algorithm>
#include <cmath>

#include "engine/viewer/view_path.h"

namespace surefield {

namespace {

constexpr double kBehind = 0.7;     // metres that a follower keeps behind the camera
constexpr double kAbove = 0.25;     // and above it
constexpr double kAhead = 1.0;      // before it lies what the follower looks at
constexpr double kSteepest = 1.45;  // radians, the steepest look up or down
constexpr double kClosest = 0.05;   // metres, the closest that the point that is looked at comes

/// Turned to the right around the vertical (downwards), and down around its own x.
Eigen::Matrix3d turned(const Eigen::Matrix3d& axes, const Eigen::Vector3d& vertical, double right,
                       double down) {
  const Eigen::Matrix3d level = Eigen::AngleAxisd(right, vertical) * axes;
  const double steep = std::asin(std::clamp(level.col(2).dot(vertical), -1.0, 1.0));
  const double change = std::clamp(steep + down, -kSteepest, kSteepest) - steep;
  return Eigen::AngleAxisd(-change, level.col(0)) * level;
}

}  // namespace

void ViewCamera::follow(const Pose& camera_to_world) {
  const Eigen::Vector3d forward = camera_to_world.linear().col(2);
  const Eigen::Vector3d place = camera_to_world.translation();
  const Eigen::Vector3d at = place + kAhead * forward;
  pose_ = look_at(place - kBehind * forward - kAbove * down_, at, -down_);
  distance_ = (at - pose_.translation()).norm();
}

void ViewCamera::look_through(const Camera& camera) {
  pose_ = camera.world_to_camera.inverse();
  lens_ = camera.intrinsics;
}

void ViewCamera::overlook(const Eigen::Vector3d& middle, double size) {
  distance_ = std::max(1.2 * size, kClosest);
  // From behind the first camera, above and a little to the right.
  const Eigen::Quaterniond upright = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitY(), down_);
  const Eigen::Vector3d back = upright * Eigen::Vector3d(0.3, -0.5, -0.8).normalized();
  pose_ = look_at(middle + distance_ * back, middle, -down_);
}

void ViewCamera::orbit(double right, double down) {
  const Eigen::Vector3d at = pose_ * Eigen::Vector3d(0, 0, distance_);
  turn(right, down);
  pose_.translation() = at - distance_ * pose_.linear().col(2);
}

void ViewCamera::turn(double right, double down) {
  pose_.linear() = turned(pose_.linear(), down_, right, down);
}

void ViewCamera::move(const Eigen::Vector3d& along) {
  pose_.translation() += pose_.linear() * along;
}

void ViewCamera::pan(double right, double down, int height) {
  const double metres = distance_ * lens_.height / lens_.fy / std::max(height, 1);
  move(metres * Eigen::Vector3d(-right, -down, 0));
}

void ViewCamera::approach(double factor) {
  const Eigen::Vector3d at = pose_ * Eigen::Vector3d(0, 0, distance_);
  distance_ = std::max(distance_ * factor, kClosest);
  pose_.translation() = at - distance_ * pose_.linear().col(2);
}

Camera ViewCamera::camera(int width, int height) const {
  return {fit_to(lens_, width, height), pose_.inverse()};
}

}  // namespace surefield
