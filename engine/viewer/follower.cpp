#include "engine/viewer/follower.h"

#include "engine/viewer/view_path.h"

namespace surefield {

namespace {

constexpr double kFollowsBehind = 1.0;  // metres that it keeps behind the tracked camera
constexpr double kFollowsAbove = 0.35;  // and above it
constexpr double kLooksAhead = 0.5;     // before the tracked camera is what it looks at
constexpr double kCatchUp = 0.125;      // of the way to where it should be, that it goes each frame

}  // namespace

void Follower::Lagging::come_after(const Eigen::Vector3d& point, double share) {
  first += share * (point - first);
  second += share * (first - second);
}

Pose Follower::follow(const Pose& camera_to_world) {
  const Eigen::Vector3d place = camera_to_world.translation();
  const double share = started_ ? kCatchUp : 1;
  started_ = true;
  place_.come_after(place, share);
  direction_.come_after(camera_to_world.linear().col(2), share);
  up_ -= camera_to_world.linear().col(1);
  const Eigen::Vector3d up =
      up_.norm() > 1e-3 ? Eigen::Vector3d(up_.normalized()) : Eigen::Vector3d(-Eigen::Vector3d::UnitY());
  // The camera may have turned round so fast that what lags behind points nowhere.
  const Eigen::Vector3d forward = direction_.second.norm() > 1e-3
                                      ? Eigen::Vector3d(direction_.second.normalized())
                                      : Eigen::Vector3d(camera_to_world.linear().col(2));
  Eigen::Vector3d from = place_.second - kFollowsBehind * forward + kFollowsAbove * up;
  if (const Eigen::Vector3d away = from - place; away.norm() < kNearest)
    from = place + kNearest * (away.norm() > 1e-6 ? Eigen::Vector3d(away.normalized()) : up);
  return look_at(from, place_.second + kLooksAhead * forward, up);
}

}  // namespace surefield
