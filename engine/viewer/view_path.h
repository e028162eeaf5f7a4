#pragma once

#include <filesystem>

#include "engine/io/camera_json.h"
#include "engine/types/camera.h"
#include "engine/types/gaussian_cloud.h"
#include "engine/types/trajectory.h"

namespace surefield {

/// The pose, camera to world, of a camera at `from` that looks at `at` (metres), with `up` upwards in its
/// image. Where it looks along `up`, its x axis is any that is level.
Pose look_at(const Eigen::Vector3d& from, const Eigen::Vector3d& at, const Eigen::Vector3d& up);

/// Where up is in the world of a trajectory: the mean of what is up in the cameras' images; the world's -y
/// where there is no camera, or they cancel out.
Eigen::Vector3d up_of(const Trajectory& trajectory);

/// The lens for pictures of another size that shows all that `lens` shows, with the middles of both at one
/// place.
Intrinsics fit_to(const Intrinsics& lens, int width, int height);

/// The way of a camera that shows a map, smooth through its keys: Catmull-Rom's cubics for places, and for
/// rotations Bezier curves on the sphere of quaternions with the same rule for speeds. Keys need not be
/// evenly spaced in time.
class ViewPath {
 public:
  /// Keys in the order of time, one at least, no two at one time, all finite. Throws UsageError.
  explicit ViewPath(Trajectory keys);

  /// The pose at that time, camera to world; at a key exactly its place. Before the first key it is the
  /// first, and after the last the last.
  Pose camera_to_world(double seconds) const;

  double begin() const { return keys_.front().timestamp; }  ///< seconds
  double end() const { return keys_.back().timestamp; }

 private:
  Trajectory keys_;
  std::vector<Eigen::Quaterniond> rotations_;   ///< of the keys; neighbours are in one half of the sphere
  std::vector<Eigen::Vector3d> velocities_;     ///< at the keys, metres a second
  std::vector<Eigen::Vector3d> turning_rates_;  ///< at the keys, radians a second, in the camera's frame
};

/// Once around the middle of a map, which it looks at from above, in `seconds`; from each side about as near
/// as nineteen in twenty of the centres of Gaussians that are not faint are in the picture.
ViewPath orbit(const GaussianCloud& map, const Intrinsics& lens, const Eigen::Vector3d& up, double seconds);

/// The middle of a map, as orbit() takes it, metres: of the upright box about the centres of Gaussians that
/// are not faint, without one in twenty at each side, so that those far off do not count. Zero where the map
/// is empty.
Eigen::Vector3d middle_of(const GaussianCloud& map, const Eigen::Vector3d& up);

/// A path with the lens of the camera that goes it.
struct RecordedViewPath {
  Intrinsics intrinsics;
  ViewPath path;
};

/// Reads a path from JSON: the intrinsics as read_camera() has them, and `keys`, a list of objects with
/// `time` (seconds) and either `world_to_camera` (four rows of four numbers) or `position` and `look_at`
/// (three numbers, metres), to which `up` may be added. Throws InputError naming the key that is missing or
/// wrong.
RecordedViewPath read_view_path(const std::filesystem::path& file);

}  // namespace surefield
