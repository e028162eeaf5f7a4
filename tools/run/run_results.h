#pragma once

#include <chrono>

#include "engine/session/kept_keyframes.h"
#include "engine/session/results_folder.h"
#include "engine/session/run_observer.h"
#include "tools/results/run_record.h"
#include "tools/run/live_meter.h"
#include "tools/shared/up_option.h"

namespace surefield {

/// What is saved of a run, and from what.
struct RunOutput {
  ResultsFolder& results;
  const FrameSource& source;
  const Trajectory* truth;  ///< null where there is none
  std::string configuration;
  std::string map_format;
  UpChoice up;
  const LiveMeter& meter;
};

/// Saves what there is of a run: what `record` knows before the run is completed with what SLAM knows.
void save_state(const RunOutput& output, RunRecord& record, const Slam& slam);

/// Saves a finished run: as save_state(), with the images of the final map measured where the run was
/// completed, and puts it into its place. Nothing that was computed replaces nothing.
void save_results(const RunOutput& output, RunRecord& record, const Slam& slam, const KeptKeyframes& kept);

/// Saves the state of a run every few keyframes, so that something is left where the program is ended by
/// force; seldom enough to take no more than a twentieth of the time.
class Checkpoints : public RunObserver {
 public:
  /// Both outlive this.
  Checkpoints(const RunOutput& output, const RunRecord& record) : output_(output), record_(record) {}

  void fed(const Frame& frame, const Slam& slam, const FrameReport& report) override;
  void skipped(const SkippedFrame& frame) override { skipped_.push_back(frame); }

 private:
  using Clock = std::chrono::steady_clock;

  const RunOutput& output_;
  const RunRecord& record_;
  std::vector<SkippedFrame> skipped_;
  int keyframes_ = 0;  ///< since the last one
  Clock::time_point begin_ = Clock::now();
  Clock::time_point next_ = begin_;
};

}  // namespace surefield
