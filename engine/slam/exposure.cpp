#include "engine/slam/exposure.h"

#include <cmath>
#include <vector>

#include "engine/types/median.h"

namespace surefield {

namespace {

constexpr float kOpaque = 0.9f;             // rendered opacity from which the map shows a surface
constexpr float kSameDepth = 0.05f;         // difference of depths, over the depth
constexpr uint8_t kDark = 12, kFull = 243;  // colours that say something about the exposure lie between
constexpr double kFewestPixels = 0.02;      // of all, for a fit
constexpr int kRounds = 5;

/// A pixel's colour in one channel, 0 to 1.
struct ColourPair {
  double measured = 0;
  double rendered = 0;
};

bool shows_same_surface(const RenderImages& rendered, std::size_t pixel, float sensor) {
  return sensor > 0 && rendered.opacity[pixel] >= kOpaque &&
         std::abs(rendered.depth_normalised[pixel] - sensor) < kSameDepth * sensor;
}

/// The ratio of the means; those that are far from it, in terms of the median distance, weigh less.
double robust_ratio(const std::vector<ColourPair>& pairs) {
  std::vector<double> errors(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) errors[i] = pairs[i].rendered / pairs[i].measured;
  double ratio = median(errors);
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < pairs.size(); ++i)
      errors[i] = std::abs(pairs[i].rendered - ratio * pairs[i].measured);
    const double scale = std::max(median(errors), 1e-6);
    double rendered = 0, measured = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const double weight = 1 / (1 + errors[i] * errors[i] / (scale * scale));
      rendered += weight * pairs[i].rendered;
      measured += weight * pairs[i].measured;
    }
    ratio = rendered / measured;
  }
  return ratio;
}

}  // namespace

std::optional<Eigen::Vector3f> fit_gains(const Frame& frame, const RenderImages& rendered) {
  std::vector<ColourPair> pairs[3];
  const auto pixels = static_cast<std::size_t>(rendered.width) * rendered.height;
  for (std::size_t i = 0; i < pixels; ++i) {
    if (!shows_same_surface(rendered, i, frame.depth.ptr<float>()[i])) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const uint8_t value = frame.colour.ptr<uint8_t>()[3 * i + c];
      if (value > kDark && value < kFull) pairs[c].push_back({value / 255.0, rendered.colour[3 * i + c]});
    }
  }
  Eigen::Vector3f gains;
  for (int c = 0; c < 3; ++c) {
    if (pairs[c].empty() ||
        static_cast<double>(pairs[c].size()) < kFewestPixels * static_cast<double>(pixels))
      return std::nullopt;
    gains[c] = static_cast<float>(robust_ratio(pairs[c]));
    if (!(gains[c] > 0)) return std::nullopt;
  }
  return gains;
}

}  // namespace surefield
