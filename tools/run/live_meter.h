#pragma once

#include <vector>

#include "engine/session/run_observer.h"
#include "tools/results/run_record.h"

namespace surefield {

/// Measures how long the frames of a live source take from their arrival until their pose is known.
class LiveMeter : public RunObserver {
 public:
  /// `unix_stamps`: the frames' stamps are seconds since 1970 by this machine's clock, so that what happened
  /// before they arrived can be measured too.
  explicit LiveMeter(bool unix_stamps) : unix_stamps_(unix_stamps) {}

  void begin(const RunStart& start) override { source_ = &start.source; }
  void tracked(const Frame& frame, const FrameReport& report) override;

  /// What was measured so far; nullopt of a source that is not live.
  std::optional<LiveRecord> record() const;

 private:
  const bool unix_stamps_;
  const FrameSource* source_ = nullptr;
  std::vector<double> from_arrival_;  ///< milliseconds, one a frame
  std::vector<double> from_stamp_;
};

}  // namespace surefield
