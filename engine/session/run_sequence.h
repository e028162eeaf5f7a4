#pragma once

#include <cstddef>
#include <exception>
#include <stop_token>
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

/// Frames at the beginning of a run that cannot be fed, after which it is given up.
inline constexpr std::size_t kHopelessFrames = 5;

/// Feeds the frames of a source to SLAM until its last frame, an interruption or an error, and then finishes
/// the Slam, unless it was interrupted or has failed. The calling thread reads frames; SLAM and the observers
/// run on a thread of their own (SlamThread). A frame that cannot be read or fed is skipped; a device that
/// fails, a lack of memory, or kHopelessFrames that cannot be fed before the first one that can, end the run;
/// so does a source of which no frame could be used. What a source gave before it throws is fed. Nothing is
/// thrown for what happens during the run, so that what was computed can be saved: Slam has it. The caller
/// has told the observers that the run begins.
///
/// Of a source whose frames come in their own time (FrameSource::live) the next one is taken when the one
/// before is done, so that it is the newest.
///
/// When `stop` is asked for, the run ends soon: no further frame is read, and mapping stops between two
/// steps.
SequenceRun run_sequence(FrameSource& source, Slam& slam, const RunObservers& observers = {},
                         const std::stop_token& stop = {});

}  // namespace surefield
