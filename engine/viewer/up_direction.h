#pragma once

#include "engine/types/gaussian_cloud.h"
#include "engine/types/trajectory.h"

namespace surefield {

/// Where up is, against gravity, in the world of a map.
struct UpDirection {
  Eigen::Vector3d up = -Eigen::Vector3d::UnitY();  ///< unit length
  bool measured = false;                           ///< by the map's surfaces
  bool given = false;  ///< by a person; where neither holds, it is as the cameras were held
};

/// Finds it: floors, ceilings and tables are level and walls upright, so up is the direction near that of the
/// cameras' images along or across which most of the map's surface faces; then the normal of the level planes
/// on which the Gaussians lie (docs/method.md, "Up"). Where there are no such planes it is the mean of what
/// is up in the cameras' images. `trajectory` is that of the cameras that saw the map.
UpDirection find_up(const GaussianCloud& map, const Trajectory& trajectory);

}  // namespace surefield
