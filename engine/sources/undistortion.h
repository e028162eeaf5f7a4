#pragma once

#include <opencv2/core.hpp>

#include "engine/sources/camera_file.h"

namespace surefield {

/// Makes images of a lens those of a pinhole with the same intrinsics. Never changes; for any threads.
class Undistortion {
 public:
  /// Leaves images as they are.
  Undistortion() = default;
  Undistortion(const Intrinsics& camera, const LensDistortion& distortion);

  /// Between pixels colour is interpolated; beyond the stored image it repeats the border: black there would
  /// be learnt as a dark frame around the scene.
  cv::Mat colour(const cv::Mat& image) const;

  /// Of depth the nearest pixel is taken; beyond the stored image there is none.
  cv::Mat depth(const cv::Mat& image) const;

 private:
  cv::Mat x_;  ///< for each undistorted pixel the place in the stored image; empty without distortion
  cv::Mat y_;
};

}  // namespace surefield
