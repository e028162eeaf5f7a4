#pragma once

#include <opencv2/core.hpp>

#include "engine/types/camera.h"

namespace surefield {

/// How a camera moves.
struct CameraMotion {
  Pose motion = Pose::Identity();  ///< from its frame to that of some time later, less than half a turn
  double seconds = 0;              ///< that time
};

/// From the camera when a depth image was taken to when its colour image was, so many seconds before
/// (Frame::depth_after): rotation and translation each go on at a constant rate. No motion where no time
/// passes.
Pose depth_to_colour(double depth_after, const CameraMotion& motion);

/// The depth image as the camera would have taken it elsewhere: `motion` takes points of the camera that took
/// it to the frame of the other, and is small (what a hand does in a few hundredths of a second). Each pixel
/// looks up which measured point it shows, in two rounds, between four pixels where these lie on one surface;
/// 0 where it shows none. CV_32FC1, metres.
cv::Mat move_depth(const cv::Mat& depth, const Intrinsics& intrinsics, const Pose& motion);

/// By how many pixels such a motion shifts what the image shows, at most, at the median of the depth; 0 where
/// there is none.
double largest_shift(const cv::Mat& depth, const Intrinsics& intrinsics, const Pose& motion);

}  // namespace surefield
