#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "engine/types/trajectory.h"

namespace surefield {

/// The poses of a camera at any time.
class PoseTrack {
 public:
  /// None: no pose is known at any time.
  PoseTrack() = default;
  /// Poses that are not finite, or of a lost camera, are left out.
  explicit PoseTrack(const Trajectory& trajectory);

  /// Camera to world at `time` between two poses that are not far apart; nullopt elsewhere.
  std::optional<Eigen::Isometry3d> at(double time) const;

  bool empty() const { return poses_.empty(); }
  /// Median time between poses, seconds.
  double spacing() const { return spacing_; }

 private:
  Trajectory poses_;
  double spacing_ = 0;
};

}  // namespace surefield
