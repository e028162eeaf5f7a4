#pragma once

#include <spdlog/logger.h>

#include "engine/session/run_observer.h"

namespace surefield {

/// Writes a line for each frame into a log.
class RunLog : public RunObserver {
 public:
  /// `log` outlives this.
  explicit RunLog(spdlog::logger& log) : log_(log) {}

  void fed(const Frame& frame, const Slam& slam, const FrameReport& report) override;
  void skipped(const SkippedFrame& frame) override;

 private:
  spdlog::logger& log_;
};

}  // namespace surefield
