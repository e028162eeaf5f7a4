#pragma once

#include <Eigen/Core>

namespace surefield::reference {

/// The real spherical harmonics up to degree 3, with the constants, order and signs of 3D Gaussian splatting:
/// one value per coefficient, as functions of a direction of unit length.
Eigen::Matrix<double, 16, 1> sh_basis(const Eigen::Vector3d& direction);

/// Derivatives of sh_basis() with respect to x, y, z of the direction, taken as if these were independent.
Eigen::Matrix<double, 16, 3> sh_basis_gradient(const Eigen::Vector3d& direction);

}  // namespace surefield::reference
