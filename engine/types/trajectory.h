#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace surefield {

/// The pose of a camera at one time.
struct StampedPose {
  double timestamp = 0;                                               ///< seconds
  Eigen::Isometry3d camera_to_world = Eigen::Isometry3d::Identity();  ///< metres

  /// Whether the camera was lost: the pose is only the last one that was known before.
  bool lost = false;

  /// False for the poses that some datasets mark as unknown with NaN or infinity.
  bool is_finite() const { return camera_to_world.matrix().allFinite(); }
};

/// Poses in the order of their file. A pose may be non-finite (unknown); its timestamp never is.
using Trajectory = std::vector<StampedPose>;

}  // namespace surefield
