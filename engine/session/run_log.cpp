#include "engine/session/run_log.h"

#include <fmt/format.h>

#include <string>

namespace surefield {

namespace {

/// How the colours of a frame were brought to the exposure of the map; nothing where they are its own.
std::string gains_of(const FrameReport& report) {
  const Eigen::Vector3f& g = report.gains;
  if (g == Eigen::Vector3f::Ones()) return "";
  return fmt::format(" colours x {:.2f} {:.2f} {:.2f},", g[0], g[1], g[2]);
}

}  // namespace

void RunLog::fed(const Frame&, const Slam&, const FrameReport& report) {
  log_.log(report.lost() ? spdlog::level::warn : spdlog::level::info,
           "frame {}:{}{}{} loss {:.5f}, valid {:.3f}, tracking {} its {:.0f} ms, mapping {} its {:.0f} ms, "
           "{} Gaussians",
           report.index, report.keyframe ? " keyframe," : "", report.lost() ? " lost," : "", gains_of(report),
           report.tracking_loss, report.valid_fraction, report.tracking_iterations, report.tracking_ms,
           report.mapping_iterations, report.mapping_ms, report.gaussians);
}

void RunLog::skipped(const SkippedFrame& frame) {
  log_.warn("frame {} skipped: {}", frame.index, frame.reason);
}

}  // namespace surefield
