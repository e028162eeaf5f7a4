#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "engine/sources/frame_stream.h"

namespace surefield {

namespace {

constexpr float kAveragedStep = 0.02f;  // of the depth

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

/// The original pixels that a pixel of the smaller image covers along one axis, with the parts that it
/// covers.
struct Cover {
  int first = 0, nearest = 0;
  std::vector<float> parts;
};

std::vector<Cover> covers(int count, double scale, int size) {
  std::vector<Cover> covers;
  for (int c = 0; c < count; ++c) {
    const double begin = c / scale, end = (c + 1) / scale;
    Cover cover{.first = static_cast<int>(begin), .nearest = nearest_source(c, scale, size)};
    for (int i = cover.first; i < std::min(end, static_cast<double>(size)); ++i)
      cover.parts.push_back(static_cast<float>(std::min(end, i + 1.0) - std::max<double>(begin, i)));
    covers.push_back(std::move(cover));
  }
  return covers;
}

/// The mean over the area, of the pixels on the surface that the nearest one shows; 0 where that one shows
/// none. Averaging is over 1 / depth, which is linear over the image of a plane, so that planes stay where
/// they are: the nearest pixel alone would be up to half a pixel beside the colour.
float mean_depth(const cv::Mat& depth, const Cover& x, const Cover& y) {
  const float nearest = depth.at<float>(y.nearest, x.nearest);
  if (!(nearest > 0)) return 0;
  float sum = 0, area = 0;
  for (std::size_t j = 0; j < y.parts.size(); ++j) {
    const float* row = depth.ptr<float>(y.first + static_cast<int>(j)) + x.first;
    for (std::size_t i = 0; i < x.parts.size(); ++i) {
      if (!(std::abs(row[i] - nearest) < kAveragedStep * nearest)) continue;
      const float part = x.parts[i] * y.parts[j];
      sum += part / row[i];
      area += part;
    }
  }
  return area / sum;
}

cv::Mat resize_depth(const cv::Mat& depth, double scale, cv::Size size) {
  const std::vector<Cover> columns = covers(size.width, scale, depth.cols);
  const std::vector<Cover> rows = covers(size.height, scale, depth.rows);
  cv::Mat resized(size, CV_32FC1);
  for (int y = 0; y < size.height; ++y) {
    auto* out = resized.ptr<float>(y);
    for (const Cover& column : columns) *out++ = mean_depth(depth, column, rows[static_cast<std::size_t>(y)]);
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
