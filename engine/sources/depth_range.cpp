#include "engine/sources/depth_range.h"

#include <algorithm>
#include <cmath>

namespace surefield {

namespace {

constexpr int kPixelStep = 2;       // in both directions: one pixel in four
constexpr double kSmallest = 1e-3;  // metres, the first bin

}  // namespace

void DepthHistogram::add(const cv::Mat& depth) {
  for (int y = 0; y < depth.rows; y += kPixelStep) {
    const auto* line = depth.ptr<float>(y);
    for (int x = 0; x < depth.cols; x += kPixelStep) add(line[x]);
  }
}

std::optional<DepthRange> DepthHistogram::range(double limit) const {
  if (valid_ == 0) return std::nullopt;
  const double last = limit > 0 ? kBinsPerDoubling * std::log2(limit / kSmallest) : kBins;
  const double first = std::clamp(last, 0.0, kBins - 1.0);
  uint64_t beyond = 0;
  for (auto bin = static_cast<std::size_t>(first) + 1; bin < kBins; ++bin) beyond += counts_[bin];
  return DepthRange{quantile(0.01), quantile(0.5), quantile(0.99),
                    static_cast<double>(holes_) / static_cast<double>(pixels()),
                    static_cast<double>(beyond) / static_cast<double>(valid_)};
}

void DepthHistogram::add(float z) {
  if (!(z > 0) || !std::isfinite(z)) {
    ++holes_;
    return;
  }
  const double bin = kBinsPerDoubling * std::log2(z / kSmallest);
  ++counts_[static_cast<std::size_t>(std::clamp(bin, 0.0, kBins - 1.0))];
  ++valid_;
}

double DepthHistogram::quantile(double share) const {
  const auto wanted = static_cast<uint64_t>(share * static_cast<double>(valid_));
  uint64_t below = 0;
  std::size_t bin = 0;
  while (bin + 1 < kBins && below + counts_[bin] <= wanted) below += counts_[bin++];
  return kSmallest * std::exp2((static_cast<double>(bin) + 0.5) / kBinsPerDoubling);
}

}  // namespace surefield
