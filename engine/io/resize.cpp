#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "engine/io/frame_stream.h"

namespace surefield {

namespace {

/// Averages over areas with exactly `scale`. OpenCV keeps the given factors only where it chooses the size
/// itself, and rounds halves to even; where it would give fewer pixels than wanted the border is repeated
/// first.
cv::Mat resize_colour(const cv::Mat& colour, double scale, cv::Size size) {
  cv::Mat source = colour;
  const int missing_x =
      cvRound(colour.cols * scale) < size.width ? static_cast<int>(std::ceil(1 / scale)) : 0;
  const int missing_y =
      cvRound(colour.rows * scale) < size.height ? static_cast<int>(std::ceil(1 / scale)) : 0;
  if (missing_x > 0 || missing_y > 0) {
    cv::copyMakeBorder(colour, source, 0, missing_y, 0, missing_x, cv::BORDER_REPLICATE);
  }
  cv::Mat resized;
  cv::resize(source, resized, cv::Size(), scale, scale, cv::INTER_AREA);
  return resized(cv::Rect({0, 0}, size)).clone();
}

/// The original pixel whose centre is nearest to that of pixel `c`: (c + 0.5) / scale - 0.5, rounded.
int nearest_source(int c, double scale, int size) {
  return std::min(static_cast<int>(std::floor((c + 0.5) / scale)), size - 1);
}

cv::Mat resize_depth(const cv::Mat& depth, double scale, cv::Size size) {
  std::vector<int> columns(static_cast<std::size_t>(size.width));
  for (int x = 0; x < size.width; ++x)
    columns[static_cast<std::size_t>(x)] = nearest_source(x, scale, depth.cols);
  cv::Mat resized(size, CV_32FC1);
  for (int y = 0; y < size.height; ++y) {
    const auto* in = depth.ptr<float>(nearest_source(y, scale, depth.rows));
    auto* out = resized.ptr<float>(y);
    for (int column : columns) *out++ = in[column];
  }
  return resized;
}

}  // namespace

Frame resize_frame(const Frame& frame, double scale) {
  if (scale == 1) return frame;
  // Intrinsics::scaled decides the size, here as for the camera.
  const Intrinsics scaled = Intrinsics{frame.colour.cols, frame.colour.rows, 1, 1, 0, 0}.scaled(scale);
  const cv::Size size(scaled.width, scaled.height);
  Frame resized = frame;
  resized.colour = resize_colour(frame.colour, scale, size);
  resized.depth = resize_depth(frame.depth, scale, size);
  return resized;
}

}  // namespace surefield
