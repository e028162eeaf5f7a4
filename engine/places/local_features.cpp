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

}  // namespace

LocalFeatures root_sift(const cv::Mat& rgb) {
  std::vector<cv::KeyPoint> points;
  cv::Mat sift;
  cv::SIFT::create(kMostFeatures, 3, kContrast)->detectAndCompute(to_grey(rgb), cv::noArray(), points, sift);
  LocalFeatures features(sift.rows, kFeatureSize);
  for (int i = 0; i < sift.rows; ++i) {
    const Eigen::Map<const Eigen::RowVectorXf> histogram(sift.ptr<float>(i), kFeatureSize);
    features.row(i) = (histogram / std::max(histogram.sum(), 1e-6f)).cwiseSqrt();
  }
  return features;
}

}  // namespace surefield
