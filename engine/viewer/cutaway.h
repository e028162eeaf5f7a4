#pragma once

#include <vector>

#include "engine/types/camera.h"
#include "engine/types/gaussian_cloud.h"
#include "engine/types/trajectory.h"

namespace surefield {

/// A map without what keeps a camera outside of it from looking in, as an orbit wants it: walls that are seen
/// from behind, and whatever hangs right before the lens. Nothing appears or vanishes at once while the
/// camera moves: what is taken out fades.
class Cutaway {
 public:
  /// `cameras` are those that the map was made from; the front of a place is where the discs there face, to
  /// the side that they saw. Without them no front is known, and only what is before the lens is taken out.
  Cutaway(GaussianCloud map, const Trajectory& cameras);

  /// The map as a camera there should show it that looks at `middle`.
  GaussianCloud seen_from(const Pose& camera_to_world, const Eigen::Vector3d& middle) const;

 private:
  GaussianCloud map_;
  std::vector<Eigen::Vector3f> fronts_;  ///< unit length; zero: not known
};

}  // namespace surefield
