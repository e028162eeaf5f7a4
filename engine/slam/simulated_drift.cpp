#include "engine/slam/simulated_drift.h"

#include <numbers>

namespace surefield {

namespace {

// In the world, the frame of the first camera; not along its axes, so that every direction is in it.
const Eigen::Vector3d kAxis = Eigen::Vector3d(1, 2, 2) / 3, kDirection = Eigen::Vector3d(2, 1, -2) / 3;
// Keyframes that are seen as if they had drifted along. Those of an earlier visit are where they are.
constexpr std::size_t kFollow = 8;

}  // namespace

Pose SimulatedDrift::drifted(const Pose& world_to_camera, double frames) const {
  const Pose camera = world_to_camera.inverse();
  const double angle = frames * settings_.rotation * std::numbers::pi / 180;
  Pose moved = Pose::Identity();
  moved.linear() = Eigen::AngleAxisd(angle, kAxis).toRotationMatrix() * camera.linear();
  moved.translation() = camera.translation() + frames * settings_.translation * kDirection;
  return moved.inverse();
}

void SimulatedDrift::begin_keyframe(const Pose& world_to_camera, double frames) {
  steps_.push_front(drifted(world_to_camera, -frames).inverse() * world_to_camera);
  if (steps_.size() > kFollow) steps_.pop_back();
}

Pose SimulatedDrift::seen_from_newest(const Pose& world_to_camera, int older) const {
  Pose seen = world_to_camera;
  if (older > static_cast<int>(steps_.size())) return seen;
  for (int i = older; i > 0; --i) seen = seen * steps_[i - 1];
  return seen;
}

}  // namespace surefield
