#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/types/camera.h"
#include "engine/types/gaussian_cloud.h"
#include "engine/types/render_images.h"

/// The oracle: the method of docs/method.md computed in double precision, slowly and obviously, for tests to
/// compare with. Conventions (frames, units, pixel centres) are those of engine/splat/camera.h.
namespace surefield::reference {

/// GaussianCloud in double precision: the same parameters, layout and units.
struct Gaussians {
  std::vector<Eigen::Vector3d> means;       ///< centre, world frame, metres
  std::vector<Eigen::Vector3d> log_scales;  ///< ln of the standard deviation along each axis, in metres
  std::vector<Eigen::Vector4d> rotations;   ///< quaternion w, x, y, z; not necessarily of unit length
  std::vector<double> opacity_logits;       ///< opacity = 1 / (1 + exp(-logit))
  int sh_degree = 0;                        ///< 0 to 3
  std::vector<double> sh;        ///< sh[(i * sh_coefficients(sh_degree) + coefficient) * 3 + channel]
  std::vector<double> sampling;  ///< no parameter: metres; 0: not known

  Gaussians() = default;

  /// Converts each parameter of `cloud` without change.
  explicit Gaussians(const GaussianCloud& cloud);

  std::size_t size() const { return means.size(); }
};

/// Constants of the forward pass (docs/method.md, "Forward") and the margins within which a discrete decision
/// counts as one that float and double arithmetic may take differently.
struct Settings {
  Eigen::Vector3d background = Eigen::Vector3d::Zero();  ///< RGB behind the Gaussians
  double near_plane = 0.01;             ///< metres; a Gaussian whose z is below takes no part
  bool plane_depth = true;              ///< else the depth is that of the centre all over the footprint
  double blur = 0.3;                    ///< pixels^2, added to the diagonal of the projected covariance
  double tangent_margin = 1.3;          ///< x/z and y/z in J are clamped to this many times the image border
  double maximum_alpha = 0.99;          ///< larger alphas are clamped, without gradient
  double minimum_alpha = 1.0 / 255.0;   ///< smaller alphas are skipped
  double minimum_transmittance = 1e-4;  ///< blending stops before the Gaussian which would take T below
  double median_transmittance = 0.5;    ///< the median Gaussian is the first which takes T below
  double edge_margin = 1e-4;            ///< relative, on alpha, T, weights, tangents and colours
  /// Relative, on z: depth order, which the device tells to 2^-17, and near plane.
  double depth_edge_margin = 2e-5;
};

/// What is rendered, row-major, width * height entries each (colour: 3 a pixel, RGB). Definitions as in
/// RenderImages.
struct Images {
  int width = 0;
  int height = 0;
  std::vector<double> colour;            ///< I = sum alpha T c + (1 - O) background
  std::vector<double> opacity;           ///< O = sum alpha T
  std::vector<double> depth;             ///< D_alpha = sum alpha T z, metres
  std::vector<double> depth_normalised;  ///< D_alpha / O, 0 where O = 0
  std::vector<double>
      depth_median;  ///< z of the Gaussian at which T first falls below 0.5; 0 where there is none
  std::vector<double>
      uncertainty;  ///< U = sum alpha T (z - D)^2, metres^2; 0 where the sensor depth is invalid
  std::vector<int32_t> dominator;  ///< Gaussian of the largest alpha T, the nearest of equals; -1 for none
  std::vector<double> dominator_weight;  ///< that alpha T; 0 where nothing was blended

  /// Pixels in which a discrete decision lies within the margins of Settings: leave them out of comparisons
  /// between float and double (for gradients: set their upstream gradients to zero). All zero from replay().
  std::vector<uint8_t>
      blend_edge;  ///< the 1/255 skip, the 0.99 clamp, the stop, the depth order, the near plane
  std::vector<uint8_t> median_edge;     ///< whether T falls below 0.5: touches depth_median alone
  std::vector<uint8_t> dominator_edge;  ///< two nearly equal largest weights: touches the dominator alone
  std::vector<uint8_t> on_edge;         ///< any of these three
  /// Per Gaussian: its tangent or colour clamp lies within the margin, so its gradients (not its values) may
  /// jump.
  std::vector<uint8_t> gaussian_edge;

  Images() = default;

  /// Images of this size, zero everywhere, with no dominator, no edges, and no Gaussians.
  Images(int image_width, int image_height);

  /// Converts the engine's images without change (no edges), so that the losses can be computed on them.
  explicit Images(const RenderImages& images);
};

/// Derivatives of a scalar loss with respect to the rendered images; layout as in Images.
struct ImageGradients {
  int width = 0;
  int height = 0;
  std::vector<double> colour;            ///< dL/dI, 3 a pixel
  std::vector<double> opacity;           ///< dL/dO
  std::vector<double> depth;             ///< dL/dD_alpha
  std::vector<double> depth_normalised;  ///< dL/d(D_alpha / O)
  std::vector<double> depth_median;      ///< dL/dD_median
  std::vector<double> uncertainty;       ///< dL/dU

  ImageGradients() = default;

  /// Gradients of this size, zero everywhere.
  ImageGradients(int image_width, int image_height);
};

/// The discrete decisions taken for one Gaussian when it was projected.
struct GaussianDecisions {
  bool culled = false;                     ///< z lies below the near plane
  std::array<int, 2> tangent_clamp{0, 0};  ///< of x/z, y/z: -1 at the lower limit, 1 at the upper, 0 inside
  std::array<bool, 3> colour_clamped{};    ///< per channel: 0.5 + SH was negative
};

/// One Gaussian blended into one pixel.
struct Contribution {
  int gaussian = 0;        ///< index
  bool saturated = false;  ///< alpha was clamped at 0.99
};

/// The discrete decisions taken in one pixel.
struct PixelDecisions {
  std::vector<Contribution> contributions;  ///< what is blended, near to far
  int median = -1;     ///< position in `contributions` of the median Gaussian; -1 for none
  int dominator = -1;  ///< position in `contributions` of the largest weight; -1 for none
};

/// All discrete decisions of one rendering. Holding them fixed makes the rendering smooth in every parameter.
struct Decisions {
  std::vector<GaussianDecisions> gaussians;
  std::vector<PixelDecisions> pixels;  ///< row-major
};

/// Which terms the gradient of the pose has; those of the Gaussians always have all.
enum class PoseTerms {
  full,   ///< all: 2D mean, z, projected covariance (through J and through R), SH view direction
  light,  ///< the 2D mean and z only: projected covariance and colour count as constants
};

/// Derivatives of a scalar loss with respect to one Gaussian as projected, summed over pixels.
struct ProjectionGradient {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();  ///< dL/d(u, v), per pixel unit
  Eigen::Matrix2d conic =
      Eigen::Matrix2d::Zero();  ///< dL/d(Sigma2^-1), symmetric: dL = sum_ij G_ij dA_ij, so
                                ///< that the off-diagonal number b has derivative 2 G_01
  Eigen::Matrix2d covariance =
      Eigen::Matrix2d::Zero();                       ///< dL/dSigma2, in the same form; derived from `conic`
  double opacity = 0;                                ///< dL/do, o after the sigmoid
  Eigen::Vector3d colour = Eigen::Vector3d::Zero();  ///< dL/dc, RGB after SH and its clamp
  double depth = 0;  ///< dL/dz, not counting what goes through mean and covariance
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< dL/d(slope of the depth), per metre a pixel
};

/// Derivatives of a scalar loss with respect to every parameter; layouts as in Gaussians.
struct Gradients {
  std::vector<Eigen::Vector3d> means;
  std::vector<Eigen::Vector3d> log_scales;
  std::vector<Eigen::Vector4d>
      rotations;  ///< with respect to the quaternion as stored, before it is normalised
  std::vector<double> opacity_logits;
  std::vector<double> sh;
  Eigen::Vector3d pose_rotation =
      Eigen::Vector3d::Zero();  ///< dL/dphi, R <- Exp(phi) R with t fixed, per radian
  Eigen::Vector3d pose_translation = Eigen::Vector3d::Zero();  ///< dL/dt, per metre
  std::vector<ProjectionGradient> projections;                 ///< per Gaussian, on the way to the above
};

/// Whether a sensor depth may be used: finite and above 0. (The loader sets depths beyond depth_max to 0.)
bool valid_depth(float depth);

}  // namespace surefield::reference
