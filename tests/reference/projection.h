#pragma once

#include "tests/reference/types.h"

namespace surefield::reference {

/// One Gaussian as a camera sees it.
struct Projection {
  GaussianDecisions decisions;
  bool near_plane_edge = false;  ///< z lies within the margin of the near plane
  bool gradient_edge = false;    ///< a tangent or colour clamp lies within the margin
  /// Centre in the camera frame, metres. Everything below is set only where its z is above 0.
  Eigen::Vector3d camera_mean = Eigen::Vector3d::Zero();
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();        ///< (u, v), pixels
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< Sigma2, with the blur, pixels^2
  Eigen::Matrix2d conic = Eigen::Matrix2d::Zero();       ///< Sigma2^-1
  double opacity = 0;                                    ///< after the sigmoid
  Eigen::Vector3d colour = Eigen::Vector3d::Zero();      ///< RGB: 0.5 + SH, clamped at 0

  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< of the depth over the footprint, metres a pixel

  double depth() const { return camera_mean.z(); }  ///< of the centre
  /// At a pixel: that of a plane through the centre.
  double depth_at(int x, int y) const { return depth() + slope.dot(Eigen::Vector2d(x, y) - mean); }
};

/// Projects Gaussian `index`. Where `held` is given, takes its discrete decisions instead of making them.
Projection project(const Gaussians& gaussians, int index, const Camera& camera, const Settings& settings,
                   const GaussianDecisions* held = nullptr);

/// Adds to `gradients` what `upstream` (derivatives with respect to `projection`, of Gaussian `index`)
/// contributes to the parameters of that Gaussian and to the pose.
void project_backward(const Gaussians& gaussians, int index, const Camera& camera, const Settings& settings,
                      const Projection& projection, const ProjectionGradient& upstream, PoseTerms pose_terms,
                      Gradients& gradients);

}  // namespace surefield::reference
