#pragma once

#include <chrono>
#include <opencv2/core.hpp>
#include <optional>

namespace surefield {

/// One RGB-D frame, colour and depth registered to one camera and undistorted.
struct Frame {
  int index = 0;           ///< position in the original sequence, before start and stride
  double timestamp = 0;    ///< seconds; the original frame index where the dataset has no stamps
  cv::Mat colour;          ///< CV_8UC3, RGB
  cv::Mat depth;           ///< CV_32FC1, metres along camera z; 0 where invalid
  double depth_after = 0;  ///< seconds from when the colour image was taken to when the depth image was
  /// When it was here as a whole, of a source whose frames come in their own time; nullopt of all others.
  std::optional<std::chrono::steady_clock::time_point> arrived = std::nullopt;
};

}  // namespace surefield
