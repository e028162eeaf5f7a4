#include "tests/reference/projection.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "tests/reference/spherical_harmonics.h"

namespace surefield::reference {

namespace {

using Matrix23d = Eigen::Matrix<double, 2, 3>;

/// The range to which x/z (axis 0) or y/z (axis 1) is clamped: the image borders' tangents times the margin.
std::array<double, 2> tangent_limits(const Intrinsics& k, int axis, const Settings& settings) {
  const double size = axis == 0 ? k.width : k.height;
  const double centre = axis == 0 ? k.cx : k.cy;
  const double focal = axis == 0 ? k.fx : k.fy;
  return {settings.tangent_margin * (-0.5 - centre) / focal,
          settings.tangent_margin * (size - 0.5 - centre) / focal};
}

/// x/z or y/z as used in J, clamped as `clamp` (-1, 0, 1) says.
double clamped_tangent(const Eigen::Vector3d& p, int axis, int clamp, const Intrinsics& k,
                       const Settings& settings) {
  const auto limits = tangent_limits(k, axis, settings);
  if (clamp == 0) return p[axis] / p.z();
  return clamp < 0 ? limits[0] : limits[1];
}

/// J = [fx/z 0 -fx x~/z^2; 0 fy/z -fy y~/z^2], where x~/z and y~/z are the clamped tangents.
Matrix23d projection_jacobian(const Eigen::Vector3d& p, const std::array<int, 2>& clamp, const Intrinsics& k,
                              const Settings& settings) {
  Matrix23d jacobian = Matrix23d::Zero();
  for (int axis = 0; axis < 2; ++axis) {
    const double focal = axis == 0 ? k.fx : k.fy;
    jacobian(axis, axis) = focal / p.z();
    jacobian(axis, 2) = -focal * clamped_tangent(p, axis, clamp[axis], k, settings) / p.z();
  }
  return jacobian;
}

Eigen::Vector4d unit_rotation(const Gaussians& gaussians, int index) {
  return gaussians.rotations[index].normalized();
}

/// Rotation matrix of a unit quaternion w, x, y, z.
Eigen::Matrix3d rotation_matrix(const Eigen::Vector4d& q) {
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

/// Rq S: its product with its transpose is Sigma.
Eigen::Matrix3d covariance_root(const Gaussians& gaussians, int index) {
  return rotation_matrix(unit_rotation(gaussians, index)) *
         gaussians.log_scales[index].array().exp().matrix().asDiagonal();
}

/// Sigma_c = R Sigma R^T.
Eigen::Matrix3d camera_covariance(const Gaussians& gaussians, int index, const Camera& camera) {
  const Eigen::Matrix3d root = camera.world_to_camera.linear() * covariance_root(gaussians, index);
  return root * root.transpose();
}

/// From the camera centre -R^T t to the Gaussian, world frame, not normalised.
Eigen::Vector3d view_vector(const Gaussians& gaussians, int index, const Camera& camera) {
  const Pose& pose = camera.world_to_camera;
  return gaussians.means[index] + pose.linear().transpose() * pose.translation();
}

double sh_coefficient(const Gaussians& gaussians, int index, int coefficient, int channel) {
  return gaussians.sh[(index * sh_coefficients(gaussians.sh_degree) + coefficient) * 3 + channel];
}

/// 0.5 + SH, before the clamp.
Eigen::Vector3d unclamped_colour(const Gaussians& gaussians, int index, const Camera& camera) {
  const auto basis = sh_basis(view_vector(gaussians, index, camera).normalized());
  Eigen::Vector3d colour = Eigen::Vector3d::Constant(0.5);
  for (int c = 0; c < sh_coefficients(gaussians.sh_degree); ++c) {
    for (int channel = 0; channel < 3; ++channel)
      colour[channel] += basis[c] * sh_coefficient(gaussians, index, c, channel);
  }
  return colour;
}

void decide(Projection& projection, const Eigen::Vector3d& colour, const Intrinsics& k,
            const Settings& settings) {
  const Eigen::Vector3d& p = projection.camera_mean;
  for (int axis = 0; axis < 2; ++axis) {
    const double tangent = p[axis] / p.z();
    const auto limits = tangent_limits(k, axis, settings);
    projection.decisions.tangent_clamp[axis] = tangent < limits[0] ? -1 : tangent > limits[1] ? 1 : 0;
    for (const double limit : limits) {
      projection.gradient_edge |= std::abs(tangent - limit) < settings.edge_margin * std::abs(limit);
    }
  }
  for (int channel = 0; channel < 3; ++channel) {
    projection.decisions.colour_clamped[channel] = colour[channel] < 0;
    projection.gradient_edge |= std::abs(colour[channel]) < settings.edge_margin;
  }
}

/// The pixels^2 on the diagonal of the 2D covariance: so many of the finest pixel that saw the Gaussian, and
/// of the camera's at least.
double blur_at(const Gaussians& gaussians, int index, const Intrinsics& k, double z,
               const Settings& settings) {
  const double sampling = gaussians.sampling.empty() ? 0 : gaussians.sampling[index];
  return settings.blur * std::max(1.0, sampling * sampling * k.fx * k.fy / (z * z));
}

/// dL/dJ to the camera-frame mean.
Eigen::Vector3d jacobian_backward(const Matrix23d& gradient, const Projection& projection,
                                  const Intrinsics& k, const Settings& settings) {
  const Eigen::Vector3d& p = projection.camera_mean;
  const double zz = p.z() * p.z();
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 2; ++axis) {
    const double focal = axis == 0 ? k.fx : k.fy;
    const int clamp = projection.decisions.tangent_clamp[axis];
    const double tangent = clamped_tangent(p, axis, clamp, k, settings);
    result.z() -= gradient(axis, axis) * focal / zz;
    if (clamp == 0) {
      result[axis] -= gradient(axis, 2) * focal / zz;
      result.z() += gradient(axis, 2) * 2 * focal * tangent / zz;
    } else {
      result.z() += gradient(axis, 2) * focal * tangent / zz;
    }
  }
  return result;
}

/// dL/dSigma (world frame) to log-scales and quaternion.
void covariance_backward(const Eigen::Matrix3d& gradient, const Gaussians& gaussians, int index,
                         Gradients& gradients) {
  const Eigen::Vector4d q = unit_rotation(gaussians, index);
  const Eigen::Vector3d scales = gaussians.log_scales[index].array().exp();
  const Eigen::Matrix3d root_gradient = 2 * gradient * covariance_root(gaussians, index);
  const Eigen::Matrix3d rotation = rotation_matrix(q);
  for (int k = 0; k < 3; ++k) {
    gradients.log_scales[index][k] += scales[k] * rotation.col(k).dot(root_gradient.col(k));
  }
  const Eigen::Matrix3d rotation_gradient = root_gradient * scales.asDiagonal();
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  std::array<Eigen::Matrix3d, 4> derivatives;  // of the rotation matrix, with respect to w, x, y, z
  derivatives[0] << 0, -z, y, z, 0, -x, -y, x, 0;
  derivatives[1] << 0, y, z, y, -2 * x, -w, z, w, -2 * x;
  derivatives[2] << -2 * y, x, w, x, 0, z, -w, z, -2 * y;
  derivatives[3] << -2 * z, -w, x, w, -2 * z, y, x, y, 0;
  Eigen::Vector4d unit_gradient;
  for (int k = 0; k < 4; ++k) unit_gradient[k] = 2 * derivatives[k].cwiseProduct(rotation_gradient).sum();
  gradients.rotations[index] +=
      (unit_gradient - q * q.dot(unit_gradient)) / gaussians.rotations[index].norm();
}

/// dL/dcolour to the SH coefficients; returns dL/d(view vector), not normalised.
Eigen::Vector3d colour_backward(const Gaussians& gaussians, int index, const Camera& camera,
                                const Projection& projection, const Eigen::Vector3d& upstream,
                                Gradients& gradients) {
  const Eigen::Vector3d view = view_vector(gaussians, index, camera);
  const Eigen::Vector3d direction = view.normalized();
  const auto basis = sh_basis(direction);
  const auto basis_gradient = sh_basis_gradient(direction);
  const int coefficients = sh_coefficients(gaussians.sh_degree);
  Eigen::Vector3d direction_gradient = Eigen::Vector3d::Zero();
  for (int channel = 0; channel < 3; ++channel) {
    if (projection.decisions.colour_clamped[channel]) continue;
    for (int c = 0; c < coefficients; ++c) {
      gradients.sh[(index * coefficients + c) * 3 + channel] += basis[c] * upstream[channel];
      direction_gradient += basis_gradient.row(c).transpose() * sh_coefficient(gaussians, index, c, channel) *
                            upstream[channel];
    }
  }
  return (direction_gradient - direction * direction.dot(direction_gradient)) / view.norm();
}

/// The derivative with respect to phi of <gradient, Exp(phi) covariance Exp(phi)^T>, both symmetric, at phi =
/// 0.
Eigen::Vector3d rotated_covariance_gradient(const Eigen::Matrix3d& gradient,
                                            const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix3d a = gradient * covariance - covariance * gradient;
  return 2 * Eigen::Vector3d(a(2, 1), a(0, 2), a(1, 0));
}

}  // namespace

Projection project(const Gaussians& gaussians, int index, const Camera& camera, const Settings& settings,
                   const GaussianDecisions* held) {
  const Intrinsics& k = camera.intrinsics;
  Projection projection;
  projection.camera_mean = camera.world_to_camera * gaussians.means[index];
  const double z = projection.depth();
  projection.decisions.culled = z < settings.near_plane;
  projection.near_plane_edge =
      std::abs(z - settings.near_plane) < settings.depth_edge_margin * settings.near_plane;
  if (z <= 0) return projection;

  const Eigen::Vector3d colour = unclamped_colour(gaussians, index, camera);
  if (held) {
    projection.decisions = *held;
  } else {
    decide(projection, colour, k, settings);
  }
  projection.mean = {k.fx * projection.camera_mean.x() / z + k.cx,
                     k.fy * projection.camera_mean.y() / z + k.cy};
  const Matrix23d jacobian =
      projection_jacobian(projection.camera_mean, projection.decisions.tangent_clamp, k, settings);
  const Eigen::Matrix3d covariance = camera_covariance(gaussians, index, camera);
  projection.covariance = jacobian * covariance * jacobian.transpose() +
                          blur_at(gaussians, index, k, z, settings) * Eigen::Matrix2d::Identity();
  projection.conic = projection.covariance.inverse();
  if (settings.plane_depth)
    projection.slope = projection.conic * jacobian * covariance * Eigen::Vector3d::UnitZ();
  projection.opacity = 1 / (1 + std::exp(-gaussians.opacity_logits[index]));
  for (int channel = 0; channel < 3; ++channel) {
    projection.colour[channel] = projection.decisions.colour_clamped[channel] ? 0 : colour[channel];
  }
  return projection;
}

void project_backward(const Gaussians& gaussians, int index, const Camera& camera, const Settings& settings,
                      const Projection& projection, const ProjectionGradient& upstream, PoseTerms pose_terms,
                      Gradients& gradients) {
  const Intrinsics& k = camera.intrinsics;
  const Eigen::Matrix3d rotation = camera.world_to_camera.linear();
  const Eigen::Vector3d& p = projection.camera_mean;
  const Matrix23d jacobian = projection_jacobian(p, projection.decisions.tangent_clamp, k, settings);
  const Eigen::Matrix3d covariance = camera_covariance(gaussians, index, camera);

  // What the light pose gradient consists of: through the 2D mean and through z.
  const Eigen::Vector3d light(
      k.fx / p.z() * upstream.mean.x(), k.fy / p.z() * upstream.mean.y(),
      upstream.depth -
          (k.fx * p.x() * upstream.mean.x() + k.fy * p.y() * upstream.mean.y()) / (p.z() * p.z()));
  // The slope q = Sigma2^-1 J Sigma_c e_z: with h = Sigma2^-1 dL/dq, dL/dSigma2 = -h q^T, made symmetric.
  const Eigen::Vector2d h =
      settings.plane_depth ? Eigen::Vector2d(projection.conic * upstream.slope) : Eigen::Vector2d::Zero();
  const Eigen::Matrix2d slope_part = h * projection.slope.transpose();
  const Eigen::Matrix2d image_gradient = upstream.covariance - (slope_part + slope_part.transpose()) / 2;
  const Matrix23d jacobian_gradient =
      2 * image_gradient * jacobian * covariance + h * covariance.col(2).transpose();
  // Where the blur follows the pixel's width in the world, it shrinks with 1 / z^2.
  const double blur = blur_at(gaussians, index, k, p.z(), settings);
  const double by_blur = blur > settings.blur ? -2 * blur / p.z() * image_gradient.trace() : 0;
  const Eigen::Vector3d full = light + jacobian_backward(jacobian_gradient, projection, k, settings) +
                               by_blur * Eigen::Vector3d::UnitZ();
  const Eigen::Matrix3d depth_part = jacobian.transpose() * h * Eigen::RowVector3d::UnitZ();
  const Eigen::Matrix3d covariance_gradient =
      jacobian.transpose() * image_gradient * jacobian + (depth_part + depth_part.transpose()) / 2;
  const Eigen::Vector3d view_gradient =
      colour_backward(gaussians, index, camera, projection, upstream.colour, gradients);

  gradients.means[index] += rotation.transpose() * full + view_gradient;
  covariance_backward(rotation.transpose() * covariance_gradient * rotation, gaussians, index, gradients);
  gradients.opacity_logits[index] += upstream.opacity * projection.opacity * (1 - projection.opacity);

  const Eigen::Vector3d rotated_mean = rotation * gaussians.means[index];
  if (pose_terms == PoseTerms::light) {
    gradients.pose_translation += light;
    gradients.pose_rotation += rotated_mean.cross(light);
    return;
  }
  const Eigen::Vector3d camera_view_gradient = rotation * view_gradient;
  gradients.pose_translation += full + camera_view_gradient;
  gradients.pose_rotation += rotated_mean.cross(full) +
                             rotated_covariance_gradient(covariance_gradient, covariance) +
                             camera_view_gradient.cross(camera.world_to_camera.translation());
}

}  // namespace surefield::reference
