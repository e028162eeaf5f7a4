#pragma once

#include <Eigen/Core>

#include "engine/types/camera.h"
#include "engine/types/frame.h"

namespace surefield {

/// The normal of the surface that a frame shows at pixel (u, v), in the camera frame, of unit length, towards
/// the camera; zero where the depth is invalid or too few neighbours belong to the same surface. It is that
/// of a plane fitted to the inverse depth of the 7 x 7 pixels around: on a plane, 1/z is linear in the pixel.
Eigen::Vector3d surface_normal(const Frame& frame, const Intrinsics& intrinsics, int u, int v);

}  // namespace surefield
