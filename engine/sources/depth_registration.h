#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "engine/types/camera.h"

namespace surefield {

/// A depth camera beside a colour camera, both without distortion.
struct DepthRegistration {
  Intrinsics depth;
  Intrinsics colour;
  Eigen::Isometry3d depth_to_colour = Eigen::Isometry3d::Identity();  ///< metres
};

/// The depth image as the colour camera would see it: CV_32FC1 of the colour camera's size, metres along its
/// z, 0 where nothing was measured. Every depth pixel covers the area that it has in the colour image, the
/// nearest one wins, and gaps between two depths of one surface are closed: of one pixel, or of as many as a
/// depth pixel becomes where the colour image is finer.
cv::Mat register_depth(const cv::Mat& depth, const DepthRegistration& cameras);

}  // namespace surefield
