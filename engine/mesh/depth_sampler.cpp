#include "engine/mesh/depth_sampler.h"

#include <algorithm>
#include <cmath>

namespace surefield {

namespace {

constexpr float kGrey = 0.7f;  // where a view has no colours

}  // namespace

DepthSampler::DepthSampler(const DepthView& view, double edge)
    : view_(view),
      width_(view.camera.intrinsics.width),
      height_(view.camera.intrinsics.height),
      edge_(static_cast<float>(edge)) {}

std::optional<float> DepthSampler::pixel_depth(int u, int v) const {
  const float z = view_.depth[static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) +
                              static_cast<std::size_t>(u)];
  if (!(z > 0) || !std::isfinite(z)) return std::nullopt;
  return z;
}

std::optional<DepthSample> DepthSampler::at(double u, double v) const {
  if (!(u >= -0.5 && v >= -0.5 && u < width_ - 0.5 && v < height_ - 0.5)) return std::nullopt;
  if (const auto between = interpolate(u, v)) return between;
  const int column = std::min(static_cast<int>(std::floor(u + 0.5)), width_ - 1);
  const int row = std::min(static_cast<int>(std::floor(v + 0.5)), height_ - 1);
  const auto z = pixel_depth(column, row);
  if (!z) return std::nullopt;
  return DepthSample{*z, pixel_colour(column, row)};
}

std::optional<DepthSample> DepthSampler::interpolate(double u, double v) const {
  if (width_ < 2 || height_ < 2) return std::nullopt;
  // In the outer half of the pixels at the border this goes on as within.
  const int left = std::clamp(static_cast<int>(std::floor(u)), 0, width_ - 2);
  const int top = std::clamp(static_cast<int>(std::floor(v)), 0, height_ - 2);
  const auto right_share = static_cast<float>(u - left);
  const auto low_share = static_cast<float>(v - top);
  float inverse = 0;
  float nearest = INFINITY;
  float farthest = 0;
  Eigen::Vector3f colour = Eigen::Vector3f::Zero();
  for (int k = 0; k < 4; ++k) {
    const int dx = k & 1;
    const int dy = k >> 1;
    const auto z = pixel_depth(left + dx, top + dy);
    if (!z) return std::nullopt;
    const float share = (dx ? right_share : 1 - right_share) * (dy ? low_share : 1 - low_share);
    inverse += share / *z;
    colour += share * pixel_colour(left + dx, top + dy);
    nearest = std::min(nearest, *z);
    farthest = std::max(farthest, *z);
  }
  if (farthest - nearest > edge_ || !(inverse > 0)) return std::nullopt;
  return DepthSample{1 / inverse, colour};
}

Eigen::Vector3f DepthSampler::pixel_colour(int u, int v) const {
  if (view_.colour.empty()) return Eigen::Vector3f::Constant(kGrey);
  return Eigen::Map<const Eigen::Vector3f>(
      view_.colour.data() +
      3 * (static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u)));
}

}  // namespace surefield
