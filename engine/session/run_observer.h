#pragma once

#include <spdlog/logger.h>

#include <vector>

#include "engine/slam/slam.h"
#include "engine/sources/frame_source.h"

namespace surefield {

/// What is known of a run when it begins.
struct RunStart {
  const FrameSource& source;       ///< of the frames that are fed; its next() is for the run alone
  const Trajectory* ground_truth;  ///< null where there is none
  const SlamSettings& settings;
  spdlog::logger& log;
};

/// What may watch a run while it goes on, and steer it. begin() and finished() are called by the thread that
/// runs the sequence, the others by that of SLAM, and never two at once.
class RunObserver {
 public:
  virtual ~RunObserver() = default;

  /// Before the first frame; what `start` refers to outlives the run.
  virtual void begin(const RunStart&) {}
  /// Before each frame; may wait, as long as the run is not interrupted, and change settings.
  virtual void before_frame(Slam&) {}
  /// A frame's pose is known, and the map is about to be worked on; see Slam::Tracked for what may be called.
  virtual void tracked(const Frame&, const FrameReport&) {}
  /// A frame was fed.
  virtual void fed(const Frame&, const Slam&, const FrameReport&) {}
  /// A frame could not be read or fed. May come late, but before the next one is fed, or before the end.
  virtual void skipped(const SkippedFrame&) {}
  /// There will be no more frames, and the results have been saved.
  virtual void finished(const Slam&) {}
};

/// Those that watch a run.
using RunObservers = std::vector<RunObserver*>;

}  // namespace surefield
