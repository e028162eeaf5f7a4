#pragma once

#include <vector>

#include "engine/eval/trajectory_metrics.h"
#include "engine/eval/triangle_tree.h"

namespace surefield {

/// The rigid transform that takes the estimated poses to the true ones: the mean of what each pair of poses
/// says. Unlike align(), which uses positions only, it is determined for a camera that moves along a line.
/// Throws InputError without pairs.
Eigen::Isometry3d align_poses(const std::vector<PosePair>& pairs);

/// Moves points, which `start` brings near a surface, onto it (point-to-plane ICP), and returns the transform
/// that does so, `start` included. Points farther than 10 cm from the surface, and of the others the tenth
/// that is farthest, take no part. Motions that the surface does not determine are not made.
Eigen::Isometry3d align_to_surface(const std::vector<Eigen::Vector3d>& points, const TriangleTree& surface,
                                   const Eigen::Isometry3d& start = Eigen::Isometry3d::Identity());

}  // namespace surefield
