#pragma once

#include "engine/types/camera.h"

namespace surefield {

/// A camera behind a tracked one and a little above it, looking where that looks: third person. It comes
/// after smoothly, by a few frames, knows nothing of the future, keeps level by what was up on average so
/// far, and never comes nearer than kNearest.
class Follower {
 public:
  static constexpr double kNearest = 0.3;  ///< metres

  /// The follower's pose at the next pose of the tracked camera; both camera to world, finite.
  Pose follow(const Pose& camera_to_world);

 private:
  /// Comes after a point in two steps, so that its speed has no jumps.
  struct Lagging {
    Eigen::Vector3d first = Eigen::Vector3d::Zero();
    Eigen::Vector3d second = Eigen::Vector3d::Zero();
    void come_after(const Eigen::Vector3d& point, double share);
  };

  Lagging place_;                                 ///< of the tracked camera, metres
  Lagging direction_;                             ///< in which it looks
  Eigen::Vector3d up_ = Eigen::Vector3d::Zero();  ///< the sum of what was up so far
  bool started_ = false;
};

}  // namespace surefield
