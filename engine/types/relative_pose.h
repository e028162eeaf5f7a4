#pragma once

#include "engine/types/camera.h"

namespace surefield {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// A measured motion between two poses of a graph, Z = T_to T_from^-1 (T: world to camera, so that Z maps
/// points of the camera `from` to the camera `to`).
struct RelativePose {
  int from = 0;
  int to = 0;
  Pose pose = Pose::Identity();  ///< Z, metres
  /// Of a small motion d = (tau, phi), metres and radians, translation first, that makes of it
  /// (Exp(phi) R, Exp(phi) t + tau): the inverse of d's covariance. Symmetric and positive semidefinite; a
  /// direction of no weight is not measured.
  Matrix6 information = Matrix6::Identity();
};

}  // namespace surefield
