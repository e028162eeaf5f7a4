#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace surefield {

/// How values become colours.
enum class ColourMap {
  Depth,  ///< viridis: near is dark blue, far is yellow
  Error   ///< inferno: none is black, large is pale yellow
};

/// What a colour-mapped image shows.
struct ColourScale {
  ColourMap map = ColourMap::Depth;
  double low = 0;
  double high = 1;
  std::string unit;
};

/// The values (CV_32FC1) as CV_8UC3, RGB, clamped to the scale; where `valid` (CV_8UC1) is 0 the image is
/// grey.
cv::Mat apply_colours(const cv::Mat& values, const cv::Mat& valid, const ColourScale& scale);

/// A bar of the scale's colours with its ends labelled, as HTML.
std::string colour_legend(const ColourScale& scale, const std::string& title);

}  // namespace surefield
