#include "tests/reference/losses.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace surefield::reference {

namespace {

void require_same_size(const Images& rendered, const Observation& observed) {
  if (observed.colour.size() != rendered.colour.size() || observed.depth.size() != rendered.depth.size()) {
    throw std::invalid_argument("the observation is not of the rendered size");
  }
}

double sign(double x) {
  return x > 0 ? 1 : x < 0 ? -1 : 0;
}

/// The mean of a sum over `count` values; 0 over none.
double mean(double sum, std::size_t count) {
  return count == 0 ? 0 : sum / static_cast<double>(count);
}

const std::vector<double>& depth_image(const Images& images, DepthKind kind) {
  return kind == DepthKind::alpha ? images.depth : images.depth_normalised;
}

std::vector<double>& depth_image(ImageGradients& gradients, DepthKind kind) {
  return kind == DepthKind::alpha ? gradients.depth : gradients.depth_normalised;
}

/// How much red, green and blue count in the intensity (Rec. 601).
constexpr double kIntensity[] = {0.299, 0.587, 0.114};

template <typename Colours>
std::vector<double> intensities(const Colours& colour) {
  std::vector<double> values(colour.size() / 3);
  for (std::size_t i = 0; i < colour.size(); ++i) values[i / 3] += kIntensity[i % 3] * colour[i];
  return values;
}

/// Mean over the masked pixels of the mean over channels of |I - observed|; adds `weight` times its
/// derivative.
double colour_term(const Images& rendered, const Observation& observed, const std::vector<uint8_t>& mask,
                   double weight, ImageGradients& gradients) {
  const std::size_t count = 3 * static_cast<std::size_t>(std::count(mask.begin(), mask.end(), 1));
  double sum = 0;
  for (std::size_t i = 0; i < rendered.colour.size(); ++i) {
    if (!mask[i / 3]) continue;
    const double difference = rendered.colour[i] - observed.colour[i];
    sum += std::abs(difference);
    gradients.colour[i] += weight * mean(sign(difference), count);
  }
  return mean(sum, count);
}

/// Mean over the masked pixels of |depth - sensor|; adds `weight` times its derivative.
double depth_term(const Images& rendered, const Observation& observed, const std::vector<uint8_t>& mask,
                  DepthKind kind, double weight, ImageGradients& gradients) {
  const std::size_t count = static_cast<std::size_t>(std::count(mask.begin(), mask.end(), 1));
  const std::vector<double>& depth = depth_image(rendered, kind);
  double sum = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (!mask[i]) continue;
    const double difference = depth[i] - observed.depth[i];
    sum += std::abs(difference);
    depth_image(gradients, kind)[i] += weight * mean(sign(difference), count);
  }
  return mean(sum, count);
}

/// L_align: mean over the pixels which have a median of |depth - D_median|; adds `weight` times its
/// derivative.
double align_term(const Images& rendered, DepthKind kind, double weight, ImageGradients& gradients) {
  const std::vector<double>& depth = depth_image(rendered, kind);
  const auto has_median = [](double median) { return median > 0; };
  const std::size_t count = static_cast<std::size_t>(
      std::count_if(rendered.depth_median.begin(), rendered.depth_median.end(), has_median));
  double sum = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (!has_median(rendered.depth_median[i])) continue;
    const double difference = depth[i] - rendered.depth_median[i];
    const double gradient = weight * mean(sign(difference), count);
    sum += std::abs(difference);
    depth_image(gradients, kind)[i] += gradient;
    gradients.depth_median[i] -= gradient;
  }
  return mean(sum, count);
}

/// L_var: mean of U over the masked pixels; adds `weight` times its derivative.
double variance_term(const Images& rendered, const std::vector<uint8_t>& mask, double weight,
                     ImageGradients& gradients) {
  const std::size_t count = static_cast<std::size_t>(std::count(mask.begin(), mask.end(), 1));
  double sum = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (!mask[i]) continue;
    sum += rendered.uncertainty[i];
    gradients.uncertainty[i] += weight * mean(1, count);
  }
  return mean(sum, count);
}

/// L_iso (eq. 17) over the visible Gaussians; adds `weight` times its derivative. Of equal scales the first
/// counts.
double isotropy_term(const Gaussians& gaussians, std::span<const uint8_t> visible, double epsilon,
                     double weight, std::vector<Eigen::Vector3d>& gradients) {
  const std::size_t count = static_cast<std::size_t>(std::count(visible.begin(), visible.end(), 1));
  double sum = 0;
  for (std::size_t i = 0; i < gaussians.size(); ++i) {
    if (!visible[i]) continue;
    Eigen::Index largest = 0, smallest = 0;
    const double ratio =
        std::exp(gaussians.log_scales[i].maxCoeff(&largest) - gaussians.log_scales[i].minCoeff(&smallest));
    if (ratio <= epsilon) continue;
    sum += ratio - epsilon;
    gradients[i][largest] += weight * mean(ratio, count);
    gradients[i][smallest] -= weight * mean(ratio, count);
  }
  return mean(sum, count);
}

std::vector<uint8_t> valid_depth_mask(const Observation& observed) {
  std::vector<uint8_t> mask;
  for (const float depth : observed.depth) mask.push_back(valid_depth(depth));
  return mask;
}

/// Median of the masked residuals, the lower of the middle two; 0 of none.
double masked_median(const std::vector<double>& residuals, const std::vector<uint8_t>& mask) {
  std::vector<double> values;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (mask[i]) values.push_back(residuals[i]);
  }
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[(values.size() - 1) / 2];
}

/// Takes the pixels whose residual is not below `limit` out of `mask`.
void drop_outliers(const std::vector<double>& residuals, double limit, std::vector<uint8_t>& mask) {
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = mask[i] && residuals[i] < limit;
}

}  // namespace

MappingLoss mapping_loss(const Images& rendered, const Observation& observed, const Gaussians& gaussians,
                         std::span<const uint8_t> visible, const MappingLossSettings& settings) {
  require_same_size(rendered, observed);
  if (visible.size() != gaussians.size()) throw std::invalid_argument("visible: one flag per Gaussian");
  MappingLoss loss;
  loss.images = ImageGradients(rendered.width, rendered.height);
  loss.log_scales.resize(gaussians.size(), Eigen::Vector3d::Zero());
  const std::vector<uint8_t> valid = valid_depth_mask(observed);

  loss.colour = colour_term(rendered, observed, valid, settings.colour, loss.images);
  const Ssim similarity = ssim(rendered.width, rendered.height, intensities(rendered.colour),
                               intensities(observed.colour), valid, 1);
  loss.ssim = 1 - similarity.value;
  for (std::size_t i = 0; i < rendered.colour.size(); ++i)
    loss.images.colour[i] -= settings.ssim * similarity.gradient[i / 3] * kIntensity[i % 3];
  loss.depth = depth_term(rendered, observed, valid, settings.depth_kind, settings.depth, loss.images);
  loss.align = align_term(rendered, settings.depth_kind, settings.align, loss.images);
  loss.isotropy =
      isotropy_term(gaussians, visible, settings.isotropy_epsilon, settings.isotropy, loss.log_scales);
  loss.variance = variance_term(rendered, valid, settings.variance, loss.images);
  loss.total = settings.colour * loss.colour + settings.ssim * loss.ssim + settings.depth * loss.depth +
               settings.align * loss.align + settings.isotropy * loss.isotropy +
               settings.variance * loss.variance;
  return loss;
}

TrackingLoss tracking_loss(const Images& rendered, const Observation& observed,
                           const TrackingLossSettings& settings) {
  require_same_size(rendered, observed);
  const std::vector<double>& depth = depth_image(rendered, settings.depth_kind);
  TrackingLoss loss;
  loss.images = ImageGradients(rendered.width, rendered.height);
  std::vector<double> colour_residuals(depth.size()), depth_residuals(depth.size());
  for (std::size_t i = 0; i < depth.size(); ++i) {
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
      colour_residuals[i] += std::abs(rendered.colour[c] - observed.colour[c]) / 3;
    }
    const bool opaque = rendered.opacity[i] > settings.minimum_opacity;
    const bool measured = valid_depth(observed.depth[i]);
    if (measured) depth_residuals[i] = std::abs(depth[i] - observed.depth[i]);
    loss.colour_mask.push_back(opaque);
    loss.depth_mask.push_back(opaque && measured);
  }
  loss.colour_median = masked_median(colour_residuals, loss.colour_mask);
  loss.depth_median = masked_median(depth_residuals, loss.depth_mask);
  drop_outliers(colour_residuals, settings.outlier_factor * loss.colour_median, loss.colour_mask);
  drop_outliers(depth_residuals, settings.outlier_factor * loss.depth_median, loss.depth_mask);

  loss.colour = colour_term(rendered, observed, loss.colour_mask, settings.colour, loss.images);
  loss.depth =
      depth_term(rendered, observed, loss.depth_mask, settings.depth_kind, settings.depth, loss.images);
  loss.total = settings.colour * loss.colour + settings.depth * loss.depth;
  return loss;
}

}  // namespace surefield::reference
