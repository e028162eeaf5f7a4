#pragma once

#include <filesystem>
#include <vector>

#include "engine/types/camera.h"

namespace surefield {

/// The name of the calibration file that own recordings bring.
inline constexpr const char* kCameraFile = "camera.yaml";

/// The camera of a recording: colour and depth are registered to it.
struct RecordedCamera {
  Intrinsics intrinsics;           ///< width and height are 0 where the file leaves them out
  std::vector<double> distortion;  ///< OpenCV's k1 k2 p1 p2 k3; empty where the images have none
  double depth_unit = 0;           ///< metres for one step of the depth images
};

/// Reads camera.yaml: fx, fy, cx, cy (pixels, centres at integers) and depth_unit (metres for one step);
/// optionally width and height (pixels, both or none) and distortion [k1, k2, p1, p2, k3]. Throws InputError
/// naming the key that is missing, unknown or wrong.
RecordedCamera read_camera_file(const std::filesystem::path& file);

}  // namespace surefield
