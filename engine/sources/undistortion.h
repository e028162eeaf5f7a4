#pragma once

#include <opencv2/core.hpp>

#include "engine/sources/camera_file.h"
#include "engine/types/frame.h"

namespace surefield {

/// Takes what a lens has bent out of images. Never changes, and may be used by any thread.
class Undistortion {
 public:
  /// Leaves images as they are.
  Undistortion() = default;
  /// Of images of the size and intrinsics of `camera`, which stay theirs.
  explicit Undistortion(const RecordedCamera& camera);

  /// Gives the frame straightened images, which are buffers of their own: colour by bilinear interpolation,
  /// depth of the nearest pixel. Does nothing where there is no distortion.
  void apply(Frame& frame) const;

 private:
  cv::Mat x_, y_;  ///< for each straight pixel the place in the stored image; empty without distortion
};

}  // namespace surefield
