#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/types/camera.h"
#include "engine/types/frame.h"
#include "engine/types/trajectory.h"

namespace surefield {

class Recording;

/// A frame that could not be read.
struct SkippedFrame {
  int index = 0;       ///< position in the original sequence
  std::string reason;  ///< one line that names the file
};

/// What a source whose frames come in their own time has counted so far.
struct LiveCounts {
  uint64_t arrived = 0;  ///< frames that came whole
  uint64_t dropped = 0;  ///< of these, those that a newer one took the place of before anybody was ready
  double seconds = 0;    ///< from the first that arrived to the last

  /// Frames a second that arrived; 0 where fewer than two did.
  double rate() const { return arrived > 1 && seconds > 0 ? static_cast<double>(arrived - 1) / seconds : 0; }
};

/// Where RGB-D frames come from: a recording, a camera, or a stream of selected frames of either. They come
/// one after the other, each once. next() and problems() are for one thread at a time; what the others say
/// never changes and may be asked by any thread.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// Name of the sequence, for reports; usually the name of its folder.
  virtual std::string name() const = 0;

  /// "tum", "replica" or another of dataset_formats(), or whatever another source calls itself.
  virtual std::string format() const = 0;

  /// Intrinsics of the frames that next() gives; those are undistorted.
  virtual Intrinsics intrinsics() const = 0;

  /// Number of frames, the unreadable ones included; nullopt where nobody knows, as of a live source.
  virtual std::optional<int> size() const = 0;

  /// The next readable frame, waiting for it if need be; nullopt after the last. Its images are the caller's:
  /// the source does not write to them again. A frame that cannot be read is passed over and noted in
  /// problems(); what stops the source altogether is thrown.
  virtual std::optional<Frame> next() = 0;

  /// There will be no more frames: has next() return nullopt from now on, also where it waits. May be called
  /// from any thread, at any time; where a source does nothing, it is left to end by itself.
  virtual void stop() {}

  /// The frames that next() has passed over so far, in order.
  virtual const std::vector<SkippedFrame>& problems() const = 0;

  /// What the source has taken for granted because nothing said so, one line each: which camera, which unit.
  virtual std::vector<std::string> assumptions() const { return {}; }

  /// Things the user should know that do not stop the run, one line each.
  virtual std::vector<std::string> warnings() const { return {}; }

  /// From the tracked camera, whose images next() gives, to the camera that ground truth describes: a point
  /// in the frame of the former becomes one in the frame of the latter. They differ where depth was
  /// registered to a colour camera and the truth is that of the depth camera.
  virtual Pose tracked_to_reference() const { return Pose::Identity(); }

  /// What has come of a source whose frames do not wait until they are asked for: next() gives the newest
  /// one, and whoever asks should be ready to work on it at once. nullopt of all others. May be called from
  /// any thread, and is then of that moment.
  virtual std::optional<LiveCounts> live() const { return std::nullopt; }

  /// Where every frame can be read again, by its Frame::index and at its original size; null where frames are
  /// gone once they were given, as those of a live source.
  virtual const Recording* recording() const { return nullptr; }
};

/// The poses of the tracked camera as poses of the camera that ground truth describes: what is written to
/// disk and compared with the truth.
Trajectory of_reference_camera(Trajectory tracked, const FrameSource& source);

/// The poses of the camera that ground truth describes as poses of the tracked camera: those at which the
/// source's images were taken.
Trajectory of_tracked_camera(Trajectory reference, const FrameSource& source);

}  // namespace surefield
