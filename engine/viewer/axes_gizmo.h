#pragma once

#include <Eigen/Core>
#include <array>

#include "engine/types/camera.h"

namespace surefield {

/// One arm of a small cross that shows how the world lies in a view.
struct AxisArm {
  const char* name = "";  ///< x, y, z, or up
  Eigen::Vector2d tip =
      Eigen::Vector2d::Zero();  ///< right and down on the image, 1 where it lies across the view
  double towards = 0;           ///< -1 (away from the viewer) to 1
  Eigen::Vector3f colour = Eigen::Vector3f::Ones();  ///< RGB, 0 to 1
};

/// The world's axes and where up is (unit length, world), as a camera sees them from far away; those that
/// point to the viewer last, so that drawn in this order they cover the others.
std::array<AxisArm, 4> axes_seen(const Pose& camera_to_world, const Eigen::Vector3d& up);

}  // namespace surefield
