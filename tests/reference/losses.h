#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tests/reference/types.h"

namespace surefield::reference {

/// Which rendered depth the depth terms use.
enum class DepthKind {
  alpha,       ///< D_alpha
  normalised,  ///< D_alpha / O
};

/// What the camera saw: row-major, as many pixels as the rendered images.
struct Observation {
  std::span<const float> colour;  ///< RGB in [0, 1], 3 a pixel
  std::span<const float> depth;   ///< metres; see valid_depth()
};

/// Weights of eq. 18 and what else it leaves open. Defaults: docs/method.md, Replica.
struct MappingLossSettings {
  double colour = 0.7;
  double ssim = 0.1;
  double depth = 0.25;
  double align = 0.25;
  double isotropy = 0.1;
  double variance = 0.15;
  double isotropy_epsilon = 1.0;  ///< ratio of the largest to the smallest scale that is not penalised
  DepthKind depth_kind = DepthKind::alpha;
};

/// The mapping loss, its six terms before weighting, and the derivatives of the weighted sum.
struct MappingLoss {
  double total = 0;
  double colour = 0;    ///< mean |I - observed| over valid sensor pixels and channels
  double ssim = 0;      ///< 1 - SSIM of the intensities of the valid sensor pixels
  double depth = 0;     ///< mean |depth - sensor| over valid sensor pixels, metres
  double align = 0;     ///< mean |depth - D_median| over pixels which have a median, metres
  double isotropy = 0;  ///< mean max(s_max / s_min, epsilon) - epsilon over visible Gaussians
  double variance = 0;  ///< mean U over valid sensor pixels, metres^2
  ImageGradients images;
  std::vector<Eigen::Vector3d> log_scales;  ///< dL/d(log_scales), through the isotropy term; per Gaussian
};

/// The mapping loss of eq. 18 over `rendered`. `visible` has one flag per Gaussian: whether it counts in the
/// isotropy term. A mean over nothing is 0; |x| has derivative 0 at 0.
MappingLoss mapping_loss(const Images& rendered, const Observation& observed, const Gaussians& gaussians,
                         std::span<const uint8_t> visible, const MappingLossSettings& settings = {});

/// Weights of eq. 19 and its masks. Defaults: docs/method.md, Replica.
struct TrackingLossSettings {
  double colour = 0.2;
  double depth = 1.0;
  double minimum_opacity = 0.99;  ///< pixels take part where O is above
  double outlier_factor = 10;     ///< and where the residual is below this many times its median
  DepthKind depth_kind = DepthKind::alpha;
};

/// The tracking loss, its terms before weighting, its masks, and the derivatives with the masks held
/// constant.
struct TrackingLoss {
  double total = 0;
  double colour = 0;  ///< mean residual over colour_mask; a pixel's is the mean of |I - observed| of channels
  double depth = 0;   ///< mean |depth - sensor| over depth_mask, metres
  double colour_median = 0;  ///< median residual of the pixels above the opacity threshold
  double depth_median = 0;   ///< the same for depth, of those that also have a valid sensor depth, metres
  std::vector<uint8_t> colour_mask;
  std::vector<uint8_t> depth_mask;
  ImageGradients images;
};

/// The tracking loss of eq. 19 over `rendered`. The median of an even number of residuals is the lower of the
/// two in the middle; of none it is 0, and so is a mean over nothing.
TrackingLoss tracking_loss(const Images& rendered, const Observation& observed,
                           const TrackingLossSettings& settings = {});

/// Mean structural similarity of two images and its derivative with respect to the first.
struct Ssim {
  double value = 0;
  std::vector<double> gradient;  ///< d value / d first, layout as the image
};

/// SSIM of two images (row-major, `channels` a pixel, in [0, 1]): per channel, 11 x 11 Gaussian window of
/// sigma 1.5, zero padding, C1 = 0.01^2, C2 = 0.03^2, averaged over channels and the pixels of `mask`; the
/// others are as if outside of the image. An empty mask: all pixels. 1 over none.
Ssim ssim(int width, int height, std::span<const double> first, std::span<const double> second,
          std::span<const uint8_t> mask = {}, int channels = 3);

}  // namespace surefield::reference
