#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "engine/types/camera.h"
#include "engine/types/frame.h"

namespace surefield {

/// Where one frame lies in a .sens file.
struct SensFrame {
  Eigen::Isometry3d camera_to_world = Eigen::Isometry3d::Identity();  ///< not finite where unknown
  uint64_t colour_at = 0;                                             ///< bytes from the start of the file
  uint64_t colour_bytes = 0;
  uint64_t depth_bytes = 0;  ///< right after the colour
};

/// How the images of a .sens file are stored; the numbers are the format's.
enum class SensColour : int32_t { Raw = 0, Png = 1, Jpeg = 2 };
enum class SensDepth : int32_t { Raw = 0, Zlib = 1, Occi = 2 };

/// What the header of a ScanNet recording says, and where its frames are.
struct SensFile {
  std::filesystem::path file;
  std::string sensor;
  Intrinsics colour;
  Intrinsics depth;
  SensColour colour_compression = SensColour::Jpeg;
  SensDepth depth_compression = SensDepth::Zlib;
  double depth_unit = 0.001;  ///< metres for one step
  uint64_t promised = 0;      ///< frames that the header announces
  std::vector<SensFrame> frames;
};

/// Reads the header of a .sens file, version 4, and finds its frames; a file that was cut off gives those
/// that are complete. Throws InputError where it is no such file, holds no complete frame, or stores its
/// depth in a way that only one device's library reads (occi).
SensFile read_sens_file(const std::filesystem::path& file);

/// Reads frame `i`: colour averaged down to the size of the depth, to which it is registered. Its index is
/// `i` and its stamp `i` seconds. Throws InputError where the frame is damaged. May be called from any
/// thread.
Frame read_sens_frame(const SensFile& sens, int i);

}  // namespace surefield
