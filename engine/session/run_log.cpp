#include "engine/session/run_log.h"

namespace surefield {

void RunLog::fed(const Frame&, const Slam&, const FrameReport& report) {
  log_.log(report.lost ? spdlog::level::warn : spdlog::level::info,
           "frame {}:{}{} loss {:.5f}, valid {:.3f}, tracking {} its {:.0f} ms, mapping {} its {:.0f} ms, "
           "{} Gaussians",
           report.index, report.keyframe ? " keyframe," : "", report.lost ? " lost," : "",
           report.tracking_loss, report.valid_fraction, report.tracking_iterations, report.tracking_ms,
           report.mapping_iterations, report.mapping_ms, report.gaussians);
}

void RunLog::skipped(const SkippedFrame& frame) {
  log_.warn("frame {} skipped: {}", frame.index, frame.reason);
}

}  // namespace surefield
