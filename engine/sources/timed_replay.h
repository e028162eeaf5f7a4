#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "engine/sources/arrival_count.h"
#include "engine/sources/recording.h"

namespace surefield {

/// A recording at its own speed, as if it came from a camera: each frame arrives when its stamp says, counted
/// from when the first one is asked for, next() waits for it, and of several that have arrived it gives the
/// newest; the others are dropped and never read.
class TimedReplay : public FrameSource {
 public:
  /// `recording` outlives this. It goes `speed` (above 0) times as fast as it was recorded. Frames that are
  /// numbered and have no stamps come 30 a second, which is an assumption. Throws InputError where the
  /// recording's stamps go back.
  explicit TimedReplay(const Recording& recording, double speed = 1);

  std::string name() const override { return recording_.name(); }
  std::string format() const override { return recording_.format(); }
  Intrinsics intrinsics() const override { return recording_.intrinsics(); }
  std::optional<int> size() const override { return std::nullopt; }
  std::optional<Frame> next() override;
  void stop() override;
  const std::vector<SkippedFrame>& problems() const override { return problems_; }
  std::vector<std::string> assumptions() const override;
  std::vector<std::string> warnings() const override { return recording_.warnings(); }
  Pose tracked_to_reference() const override { return recording_.tracked_to_reference(); }
  std::optional<LiveCounts> live() const override { return arrivals_.counts(dropped_); }
  const Recording* recording() const override { return &recording_; }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point due(int i) const;
  bool wait_until(Clock::time_point moment);
  std::optional<int> newest_due();

  const Recording& recording_;
  std::vector<double> seconds_;  ///< from the first frame on, by the clock of the replay
  bool numbered_ = false;        ///< whether the frames have no stamps of their own
  int next_ = 0;
  std::optional<Clock::time_point> begin_;
  std::vector<SkippedFrame> problems_;
  ArrivalCount arrivals_;
  std::atomic<uint64_t> dropped_{0};

  std::mutex mutex_;
  std::condition_variable ending_;
  bool stopped_ = false;
};

}  // namespace surefield
