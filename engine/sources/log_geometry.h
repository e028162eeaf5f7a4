#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/sources/camera_file.h"
#include "engine/sources/frame_tree.h"
#include "engine/sources/log_topics.h"

namespace surefield {

/// The cameras of a log: that of the colour images, and where depth is not registered to it, its own.
struct LogCameras {
  RecordedCamera camera;
  std::vector<std::string> assumptions;
  std::vector<std::string> warnings;
};

/// The frames that the log's tf_static and tf describe.
FrameTree read_frames_of(const LogReader& log);

/// The cameras as CameraInfo, tf and topics of extrinsics tell them, or a camera.yaml beside the log or the
/// options. Throws InputError naming what is missing and how it can be given.
LogCameras find_cameras(const LogReader& log, const LogChoice& choice, const FrameTree& frames,
                        const DatasetOptions& options);

}  // namespace surefield
