#pragma once

#include <exception>
#include <functional>
#include <vector>

#include "engine/session/run_observer.h"
#include "engine/slam/slam.h"
#include "engine/sources/frame_source.h"

namespace surefield {

/// How a run ended.
enum class RunEnd { Completed, Interrupted, Failed };

/// What became of a sequence.
struct SequenceRun {
  RunEnd end = RunEnd::Completed;
  std::exception_ptr failure;         ///< why it failed; null where it did not
  std::vector<SkippedFrame> skipped;  ///< frames that could not be read or fed, by their index
  double seconds = 0;                 ///< from the first frame asked for to the last one done
};

/// Feeds the frames of a source to SLAM until its last frame, an interruption or an error, and then finishes
/// the Slam, unless it was interrupted or has failed. The calling thread reads frames; SLAM and the observers
/// run on a thread of their own (SlamThread). A frame that cannot be read or fed is skipped; a device that
/// fails, or a lack of memory, ends the run. Nothing is thrown for what happens during the run, so that what
/// was computed can be saved: Slam has it. The caller has told the observers that the run begins.
///
/// `interrupted` is asked between frames, by both threads; where it says yes, the frame in work is the last.
SequenceRun run_sequence(FrameSource& source, Slam& slam, const RunObservers& observers = {},
                         const std::function<bool()>& interrupted = {});

}  // namespace surefield
