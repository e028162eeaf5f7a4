#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "engine/eval/pose_track.h"
#include "engine/sources/recording.h"

namespace surefield {

/// What may be wrong with a dataset's calibration, as what would have to be done to what it says. The default
/// takes the dataset at its word.
struct Correction {
  double depth_scale = 1;  ///< depth is multiplied by it
  double focal = 1;        ///< fx and fy are multiplied by it
  double aspect = 1;       ///< fx is multiplied by it, fy divided
  double depth_focal = 1;  ///< fx and fy of the depth image alone, about the principal point
  double shift_x = 0;      ///< depth image against colour, pixels of the checked images, to the right
  double shift_y = 0;      ///< the same, downwards
  double pose_delay = 0;   ///< added to the stamps of the images before poses are looked up
  double depth_delay = 0;  ///< added to the stamps of the depth images alone
};

/// A pixel with depth.
struct DepthPoint {
  float x = 0;  ///< pixels
  float y = 0;  ///< pixels
  float z = 0;  ///< metres
};

/// A frame as the checks need it.
struct CheckFrame {
  int index = 0;
  double timestamp = 0;            ///< of the colour image
  double depth_timestamp = 0;      ///< of the depth image
  cv::Mat grey;                    ///< CV_32F, 0 to 255
  cv::Mat texture;                 ///< CV_32F, grey levels without what is smooth, and so without exposure
  cv::Mat contrast;                ///< CV_32F, strength of the colour edges, 1 on average
  cv::Mat depth;                   ///< CV_32F, metres
  std::vector<DepthPoint> points;  ///< depth where the image has texture
  std::vector<DepthPoint> rims;    ///< depth on the near side of depth edges
};

/// Prepares a frame that is already of the size to check at. `depth_timestamp` in seconds.
CheckFrame prepare_frame(const Frame& frame, double depth_timestamp);

/// Strength of the edges of a colour image, CV_8UC3: CV_32F, 1 on average.
cv::Mat edge_contrast(const cv::Mat& colour);

/// Points on the near side of the edges of a depth image, CV_32F, metres.
std::vector<DepthPoint> depth_rims(const cv::Mat& depth);

/// Mean of edge_contrast() at the rims of a depth image that is shifted by so many pixels; nullopt where
/// there are too few.
std::optional<double> mean_contrast(const cv::Mat& contrast, const std::vector<DepthPoint>& rims,
                                    const cv::Point2d& shift);

/// Two frames that see much of the same, by their places in the list of frames.
struct FramePair {
  std::size_t from = 0;
  std::size_t to = 0;
};

/// Frames, the camera that took them, and their true poses.
struct CheckScene {
  Intrinsics intrinsics;
  std::vector<CheckFrame> frames;
  std::vector<FramePair> pairs;
  PoseTrack track;
};

/// Mean difference of texture, grey levels, between each pair's first frame warped into the second and the
/// second, under a correction; nullopt where too little can be compared.
std::vector<std::optional<double>> texture_errors(const CheckScene& scene, const Correction& correction);

/// Mean strength of the colour edges at each frame's depth edges, under a correction: highest where colour
/// and depth fit. nullopt for frames with too few depth edges, or without a pose where the correction needs
/// one.
std::vector<std::optional<double>> edge_strengths(const CheckScene& scene, const Correction& correction);

/// How well the pairs fit as the dataset stands.
struct WarpError {
  int pairs = 0;            ///< those that could be compared
  double grey_levels = 0;   ///< mean absolute difference of brightness where depths agree, 0 to 255
  double depth_median = 0;  ///< median absolute difference of depth, metres
};
WarpError warp_error(const CheckScene& scene);

}  // namespace surefield
