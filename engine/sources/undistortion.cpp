#include "engine/sources/undistortion.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace surefield {

Undistortion::Undistortion(const RecordedCamera& camera) {
  if (camera.distortion.empty()) return;
  const Intrinsics& k = camera.intrinsics;
  const cv::Matx33d matrix(k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1);
  const cv::Size size(k.width, k.height);
  const auto& coefficients = camera.distortion.coefficients;
  if (camera.distortion.model == LensDistortion::Model::Fisheye) {
    cv::fisheye::initUndistortRectifyMap(matrix, coefficients, cv::Matx33d::eye(), matrix, size, CV_32FC1, x_,
                                         y_);
  } else {
    cv::initUndistortRectifyMap(matrix, coefficients, cv::noArray(), matrix, size, CV_32FC1, x_, y_);
  }
}

void Undistortion::apply(Frame& frame) const {
  if (x_.empty()) return;
  cv::Mat colour;
  cv::Mat depth;
  // Beyond the stored image colour repeats the border: black there would be learnt as a dark frame around the
  // scene.
  cv::remap(frame.colour, colour, x_, y_, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::remap(frame.depth, depth, x_, y_, cv::INTER_NEAREST, cv::BORDER_CONSTANT, 0);
  frame.colour = colour;
  frame.depth = depth;
}

}  // namespace surefield
