#pragma once

#include <opencv2/core.hpp>

#include "engine/types/camera.h"

namespace surefield {

/// The part `share` of a motion, one of less than half a turn: rotation and translation each at a constant rate.
Pose part_of_motion(const Pose& motion, double share);

/// The depth image as the camera would have taken it elsewhere: `motion` takes points of the camera that took
/// it to the frame of the other, and is small (what a hand does in a few hundredths of a second). Each pixel
/// looks up which measured point it shows, in two rounds, between four pixels where these lie on one surface;
/// 0 where it shows none. CV_32FC1, metres.
cv::Mat move_depth(const cv::Mat& depth, const Intrinsics& intrinsics, const Pose& motion);

}  // namespace surefield
