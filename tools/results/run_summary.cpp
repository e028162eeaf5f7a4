#include <fmt/format.h>

#include "tools/results/run_record.h"
#include "tools/results/trajectory_report.h"

namespace surefield {

namespace {

constexpr std::size_t kNamedFrames = 10;  // more would push the results off the screen; log.txt has them all

std::string frames_line(const RunRecord& record) {
  std::string text =
      fmt::format("frames           {}{}, {} keyframes", record.frames.size(),
                  record.selected ? fmt::format(" of {}", *record.selected) : "", record.keyframes.size());
  const int lost = count_frames(record.frames, [](const FrameReport& frame) { return frame.lost; });
  const int retried = count_frames(record.frames, [](const FrameReport& frame) { return frame.retries > 0; });
  if (retried > 0) text += fmt::format(", {} tracked again from another pose", retried);
  if (lost > 0) text += fmt::format(", {} lost", lost);
  if (!record.skipped.empty()) text += fmt::format(", {} skipped", record.skipped.size());
  return text + "\n";
}

std::string iterations_line(const char* title, const IterationTotal& total) {
  return fmt::format("{:<16} {:.2f} ms x {} iterations = {:.1f} s\n", title, total.milliseconds_each(),
                     total.iterations, total.seconds);
}

std::string skipped_lines(const RunRecord& record) {
  std::string text;
  for (std::size_t i = 0; i < record.skipped.size() && i < kNamedFrames; ++i) {
    text += fmt::format("skipped          frame {}: {}\n", record.skipped[i].index, record.skipped[i].reason);
  }
  if (record.skipped.size() > kNamedFrames) {
    text += fmt::format("                 and {} more; see log.txt\n", record.skipped.size() - kNamedFrames);
  }
  return text;
}

IterationTotal total(const std::vector<FrameReport>& frames, int FrameReport::*iterations,
                     double FrameReport::*milliseconds) {
  IterationTotal sum;
  for (const FrameReport& frame : frames) {
    sum.iterations += frame.*iterations;
    sum.seconds += frame.*milliseconds / 1000;
  }
  return sum;
}

}  // namespace

IterationTotal tracking_total(const std::vector<FrameReport>& frames) {
  return total(frames, &FrameReport::tracking_iterations, &FrameReport::tracking_ms);
}

IterationTotal mapping_total(const std::vector<FrameReport>& frames) {
  return total(frames, &FrameReport::mapping_iterations, &FrameReport::mapping_ms);
}

std::string run_summary(const RunRecord& record) {
  std::string text = frames_line(record);
  text += skipped_lines(record);
  if (record.accuracy) text += trajectory_table(*record.accuracy);
  if (record.keyframe_accuracy) {
    text += fmt::format("keyframes' ATE   {:.3f} cm\n", 100 * record.keyframe_accuracy->ate.rmse);
  }
  text += fmt::format("speed            {:.2f} frames/s, {:.1f} s in all\n", record.frames_per_second(),
                      record.seconds);
  text += iterations_line("tracking", tracking_total(record.frames));
  text += iterations_line("mapping", mapping_total(record.frames));
  text += fmt::format("map              {} Gaussians, {:.1f} MB\n", record.gaussians(),
                      static_cast<double>(record.engine.map_bytes) / 1e6);
  if (record.images) text += quality_table(*record.images);
  return text;
}

}  // namespace surefield
