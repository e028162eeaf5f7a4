#include "engine/places/local_features.h"

#include <algorithm>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace surefield {

namespace {

constexpr int kWidth = 320;         // pixels; finer detail differs between views of a place
constexpr int kMostFeatures = 500;  // the strongest
constexpr double kContrast = 0.02;  // below OpenCV's own 0.04: plain rooms have few strong features

cv::Mat to_grey(const cv::Mat& rgb) {
  cv::Mat grey, reduced;
  cv::cvtColor(rgb, grey, cv::COLOR_RGB2GRAY);
  if (grey.cols <= kWidth) return grey;
  const double scale = static_cast<double>(kWidth) / grey.cols;
  cv::resize(grey, reduced, cv::Size(kWidth, cvRound(grey.rows * scale)), 0, 0, cv::INTER_AREA);
  return reduced;
}

constexpr float kSteps = 512;  // of 1, in bytes

}  // namespace

FeatureBytes to_bytes(const LocalFeatures& features) {
  return (features.array() * kSteps).round().cwiseMin(255.0f).cast<uint8_t>();
}

LocalFeatures to_floats(const FeatureBytes& features) {
  LocalFeatures floats = features.cast<float>();
  for (Eigen::Index i = 0; i < floats.rows(); ++i) floats.row(i).normalize();  // zeros stay
  return floats;
}

ImageFeatures find_features(const cv::Mat& rgb) {
  const cv::Mat grey = to_grey(rgb);
  std::vector<cv::KeyPoint> points;
  cv::Mat sift;
  cv::SIFT::create(kMostFeatures, 3, kContrast)->detectAndCompute(grey, cv::noArray(), points, sift);
  ImageFeatures features{LocalFeatures(sift.rows, kFeatureSize), {}};
  const float across = static_cast<float>(rgb.cols) / static_cast<float>(grey.cols);
  const float down = static_cast<float>(rgb.rows) / static_cast<float>(grey.rows);
  for (int i = 0; i < sift.rows; ++i) {
    const Eigen::Map<const Eigen::RowVectorXf> histogram(sift.ptr<float>(i), kFeatureSize);
    features.descriptors.row(i) = (histogram / std::max(histogram.sum(), 1e-6f)).cwiseSqrt();
    const cv::Point2f& at = points[static_cast<std::size_t>(i)].pt;
    features.pixels.emplace_back(across * (at.x + 0.5f) - 0.5f, down * (at.y + 0.5f) - 0.5f);
  }
  return features;
}

}  // namespace surefield
