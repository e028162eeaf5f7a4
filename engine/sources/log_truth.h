#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/sources/frame_tree.h"
#include "engine/sources/log_reader.h"
#include "engine/types/trajectory.h"

namespace surefield {

/// True poses that a log has.
struct LogTruth {
  std::string topic;  ///< that they come from; empty where there are none
  Trajectory poses;   ///< of the frame that `tracked_to_reference` leads to
  Pose tracked_to_reference = Pose::Identity();
  std::vector<std::string> assumptions;
};

/// The poses of a topic of odometry or poses, preferring one that is named for truth; else those of tf, where
/// one link alone moves above the colour camera, whose frame is `camera`.
LogTruth find_truth(const LogReader& log, const FrameTree& frames, const std::string& camera);

}  // namespace surefield
