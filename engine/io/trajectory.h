#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <vector>

namespace surefield {

/// The pose of a camera at one time.
struct StampedPose {
  double timestamp = 0;                                               ///< seconds
  Eigen::Isometry3d camera_to_world = Eigen::Isometry3d::Identity();  ///< metres

  /// False for the poses that some datasets mark as unknown with NaN or infinity.
  bool is_finite() const { return camera_to_world.matrix().allFinite(); }
};

/// Poses in the order of their file. A pose may be non-finite (unknown); its timestamp never is.
using Trajectory = std::vector<StampedPose>;

/// Reads a trajectory in TUM format: lines "timestamp tx ty tz qx qy qz qw", camera to world, '#' starts a
/// comment. Quaternions are normalised. A line with NaN or infinity becomes a pose that is not finite. Throws
/// InputError with the line number where a line cannot be read.
Trajectory read_trajectory(const std::filesystem::path& file);

/// Writes a trajectory in TUM format: stamps with 6 decimals, values with 9 significant digits, quaternions
/// with qw >= 0. The same poses give the same bytes. Throws InputError when the file cannot be written.
void write_trajectory(const std::filesystem::path& file, const Trajectory& trajectory);

}  // namespace surefield
