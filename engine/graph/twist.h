#pragma once

#include "engine/types/relative_pose.h"

namespace surefield {

// Small motions d = (tau, phi) of a pose T, metres and radians, translation first, from the left:
//   T <- (Exp(phi) R, Exp(phi) t + tau).

/// The matrix of the cross product with `v`.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v);

/// The rotation about `phi` by its length.
Eigen::Matrix3d rotation_of(const Eigen::Vector3d& phi);

/// The inverse of rotation_of(), at most pi long; exact near pi too.
Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& rotation);

/// The inverse of SO(3)'s left Jacobian: Log(Exp(e) Exp(phi)) = phi + J e for small e.
Eigen::Matrix3d left_jacobian_inverse(const Eigen::Vector3d& phi);

/// T moved by d. Its rotation stays orthonormal to double precision.
Pose moved(const Pose& pose, const Vector6& d);

/// The d that makes `to` of `from`: moved(from, motion_between(from, to)) is `to`.
Vector6 motion_between(const Pose& from, const Pose& to);

/// The derivative of motion_between(from, moved(to, d)) by d at 0, where its value is `motion`.
Matrix6 motion_jacobian(const Vector6& motion);

/// Ad(Z) = [R, [t]x R; 0, R]: a small motion d of T_i moves Z = T_j T_i^-1 by -Ad(Z) d to first order.
Matrix6 adjoint(const Pose& pose);

}  // namespace surefield
