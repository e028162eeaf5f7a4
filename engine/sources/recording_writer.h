#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "engine/sources/recording.h"
#include "engine/types/trajectory.h"

namespace surefield {

/// What a recording that is written holds.
struct WrittenRecording {
  std::string name;
  Intrinsics intrinsics;  ///< of the frames, which are undistorted and registered
  double depth_unit = 0;  ///< metres for one step, where depth is stored in steps
  bool lossy = false;     ///< rounds what the layout cannot hold, instead of refusing it
};

/// A frame with when each of its images was taken, seconds.
struct WrittenFrame {
  Frame frame;  ///< stamp of the colour image
  double depth_timestamp = 0;
};

/// Writes a recording in a layout that open_dataset() reads, frame by frame. What is read back has the same
/// bits: pixels, depths and stamps; where the layout cannot hold them, write() throws InputError that says
/// what, unless `lossy` was asked for. A writer that is destroyed before finish() leaves nothing behind. Not
/// thread-safe.
class RecordingWriter {
 public:
  virtual ~RecordingWriter() = default;
  virtual void write(const WrittenFrame& frame) = 0;
  /// After the last frame. `truth` are poses of the tracked camera, where they are known.
  virtual void finish(const std::optional<Trajectory>& truth) = 0;
};

/// A folder as TUM's benchmark has it: rgb/ and depth/ with a list of each, camera.yaml, groundtruth.txt.
/// Throws InputError where `folder` is there and not empty, or cannot be written.
std::unique_ptr<RecordingWriter> write_tum(const std::filesystem::path& folder,
                                           const WrittenRecording& recording);
/// A folder of the plain layout: colour/ and depth/ with timestamps.txt, camera.yaml, poses.txt. It has one
/// stamp for both images.
std::unique_ptr<RecordingWriter> write_plain(const std::filesystem::path& folder,
                                             const WrittenRecording& recording);
/// A log of ROS 2's: raw colour images, depth images of 32-bit metres registered to them, their camera, and
/// poses. Any depth fits; stamps are rounded to nanoseconds.
std::unique_ptr<RecordingWriter> write_mcap(const std::filesystem::path& file,
                                            const WrittenRecording& recording);

}  // namespace surefield
