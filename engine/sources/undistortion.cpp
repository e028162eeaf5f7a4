#include "engine/sources/undistortion.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace surefield {

Undistortion::Undistortion(const Intrinsics& k, const LensDistortion& distortion) {
  if (distortion.empty()) return;
  const cv::Matx33d camera(k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1);
  const cv::Size size(k.width, k.height);
  const auto& coefficients = distortion.coefficients;
  if (distortion.model == LensDistortion::Model::Fisheye) {
    cv::fisheye::initUndistortRectifyMap(camera, coefficients, cv::Matx33d::eye(), camera, size, CV_32FC1, x_,
                                         y_);
  } else {
    cv::initUndistortRectifyMap(camera, coefficients, cv::noArray(), camera, size, CV_32FC1, x_, y_);
  }
}

cv::Mat Undistortion::colour(const cv::Mat& image) const {
  if (x_.empty()) return image;
  cv::Mat straight;
  cv::remap(image, straight, x_, y_, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return straight;
}

cv::Mat Undistortion::depth(const cv::Mat& image) const {
  if (x_.empty()) return image;
  cv::Mat straight;
  cv::remap(image, straight, x_, y_, cv::INTER_NEAREST, cv::BORDER_CONSTANT, 0);
  return straight;
}

}  // namespace surefield
