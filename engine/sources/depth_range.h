#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>

namespace surefield {

/// What depth images hold.
struct DepthRange {
  double near = 0;    ///< metres, a hundredth of the depths is less, to 3 percent
  double median = 0;  ///< metres, to 3 percent
  double far = 0;     ///< metres, a hundredth of the depths is more, to 3 percent
  double holes = 0;   ///< share of the pixels without depth
  double beyond = 0;  ///< share of the depths that exceed a limit, to 3 percent of that
};

/// Counts depths, CV_32FC1 in metres, by their logarithm: any range, the same relative precision.
class DepthHistogram {
 public:
  /// Looks at one pixel in four.
  void add(const cv::Mat& depth);

  /// What was counted so far; `limit`, metres, is that of DepthRange::beyond; 0: none. Nothing where no pixel
  /// had depth.
  std::optional<DepthRange> range(double limit) const;

  /// Pixels looked at.
  uint64_t pixels() const { return valid_ + holes_; }

 private:
  static constexpr int kBinsPerDoubling = 24;
  static constexpr std::size_t kBins = 26 * kBinsPerDoubling;  // up to 67 km

  void add(float z);
  double quantile(double share) const;

  std::array<uint64_t, kBins> counts_{};
  uint64_t valid_ = 0;
  uint64_t holes_ = 0;
};

}  // namespace surefield
