#include "engine/formats/gaussian_order.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace surefield {

namespace {

constexpr double kMortonCells = (1 << 21) - 1;  // along each axis: three times 21 bits fill a number of 64

/// The lowest 21 bits, each two places away from the next.
uint64_t spread(uint64_t bits) {
  bits = (bits | bits << 32) & 0x001f00000000ffff;
  bits = (bits | bits << 16) & 0x001f0000ff0000ff;
  bits = (bits | bits << 8) & 0x100f00f00f00f00f;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
  return (bits | bits << 2) & 0x1249249249249249;
}

}  // namespace

bool is_finite(const GaussianCloud& cloud, std::size_t i) {
  const auto stride = static_cast<std::ptrdiff_t>(sh_coefficients(cloud.sh_degree)) * 3;
  const auto sh = cloud.sh.begin() + static_cast<std::ptrdiff_t>(i) * stride;
  return cloud.means[i].allFinite() && cloud.log_scales[i].allFinite() && cloud.rotations[i].allFinite() &&
         !cloud.rotations[i].isZero(0) && std::isfinite(cloud.opacity_logits[i]) &&
         std::all_of(sh, sh + stride, [](float value) { return std::isfinite(value); });
}

std::vector<std::size_t> finite_gaussians(const GaussianCloud& cloud) {
  std::vector<std::size_t> gaussians;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (is_finite(cloud, i)) gaussians.push_back(i);
  return gaussians;
}

void sort_along_morton_curve(const GaussianCloud& cloud, std::vector<std::size_t>& gaussians) {
  if (gaussians.empty()) return;
  Eigen::Array3d low = cloud.means[gaussians.front()].cast<double>(), high = low;
  for (std::size_t i : gaussians) {
    low = low.min(cloud.means[i].cast<double>().array());
    high = high.max(cloud.means[i].cast<double>().array());
  }
  const Eigen::Array3d extent = (high > low).select(high - low, 1);
  std::vector<std::pair<uint64_t, std::size_t>> coded;
  coded.reserve(gaussians.size());
  for (std::size_t i : gaussians) {
    const Eigen::Array3d cell = (cloud.means[i].cast<double>().array() - low) / extent * kMortonCells;
    const auto along = [&](Eigen::Index axis) { return spread(static_cast<uint64_t>(cell[axis])); };
    coded.emplace_back(along(0) | along(1) << 1 | along(2) << 2, i);
  }
  std::sort(coded.begin(), coded.end());
  std::transform(coded.begin(), coded.end(), gaussians.begin(), [](const auto& code) { return code.second; });
}

GaussianCloud select(const GaussianCloud& cloud, const std::vector<std::size_t>& gaussians) {
  const auto stride = static_cast<std::ptrdiff_t>(sh_coefficients(cloud.sh_degree)) * 3;
  GaussianCloud selected;
  selected.sh_degree = cloud.sh_degree;
  for (std::size_t i : gaussians) {
    const auto sh = cloud.sh.begin() + static_cast<std::ptrdiff_t>(i) * stride;
    selected.means.push_back(cloud.means[i]);
    selected.log_scales.push_back(cloud.log_scales[i]);
    selected.rotations.push_back(cloud.rotations[i]);
    selected.opacity_logits.push_back(cloud.opacity_logits[i]);
    selected.sh.insert(selected.sh.end(), sh, sh + stride);
    selected.uncertainty.push_back(cloud.uncertainty[i]);
    selected.sampling.push_back(cloud.sampling[i]);
    selected.anchors.push_back(cloud.anchors[i]);
  }
  return selected;
}

}  // namespace surefield
