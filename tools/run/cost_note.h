#pragma once

#include <chrono>
#include <optional>

#include "engine/session/run_observer.h"

namespace surefield {

/// Tells the user once, where the device is a CPU and the images have their full size, how long the run will
/// take, and that smaller images take less: nobody should have to find that out by waiting.
class CostNote : public RunObserver {
 public:
  /// `scale` is that of the images.
  explicit CostNote(double scale) : wanted_(scale == 1) {}

  void begin(const RunStart& start) override { frames_ = start.source.size(); }
  void fed(const Frame& frame, const Slam& slam, const FrameReport& report) override;

 private:
  using Clock = std::chrono::steady_clock;

  bool wanted_;
  std::optional<int> frames_;
  int fed_ = 0;
  Clock::time_point second_;  ///< when the first frame was done, which takes far longer than the others
};

}  // namespace surefield
