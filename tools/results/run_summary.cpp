#include <fmt/format.h>
#include <algorithm>

#include <cmath>

#include "tools/results/run_record.h"
#include "tools/results/trajectory_report.h"
#include "tools/shared/numbers.h"

namespace surefield {

namespace {

constexpr std::size_t kNamedFrames = 10;  // more would push the results off the screen; log.txt has them all

std::string frames_line(const RunRecord& record) {
  std::string text =
      fmt::format("frames           {}{}, {} keyframes", record.frames.size(),
                  record.selected ? fmt::format(" of {}", *record.selected) : "", record.keyframes.size());
  const int lost = count_frames(record.frames, [](const FrameReport& frame) { return frame.lost(); });
  const int retried = count_frames(record.frames, [](const FrameReport& frame) { return frame.retries > 0; });
  if (retried > 0) text += fmt::format(", {} tracked again from another pose", retried);
  const int poor = count_frames(record.frames,
                                [](const FrameReport& frame) { return frame.state == TrackingState::Poor; });
  if (poor > 0) text += fmt::format(", {} poor", poor);
  if (lost > 0) text += fmt::format(", {} lost", lost);
  if (!record.skipped.empty()) text += fmt::format(", {} skipped", record.skipped.size());
  return text + "\n";
}

/// What tracking or mapping took of each of so many frames or keyframes.
std::string cost_line(const char* title, const IterationTotal& total, std::size_t count, const char* each) {
  const auto per = [&](double whole) { return count > 0 ? whole / static_cast<double>(count) : NAN; };
  return fmt::format("{:<16} {} ms a {} ({} iterations of {} ms), {:.1f} s in all\n", title,
                     shown(per(1000 * total.seconds), 1), each, shown(per(total.iterations), 1),
                     shown(total.milliseconds_each(), 2), total.seconds);
}

/// Only where depth images have stamps of their own.
std::string depth_delay_line(const RunRecord& record) {
  if (!record.estimated_depth_delay) return {};
  const DepthDelay& delay = *record.estimated_depth_delay;
  const double used = 1000 * record.depth_delay, error = 1000 * delay.error;
  if (!delay.known()) return "depth delay      0 ms, as nothing tells it; --depth-delay sets it\n";
  if (used == 0) {
    return fmt::format(
        "depth delay      0 ms, as {:+.0f} +- {:.0f} ms is not certain; --depth-delay sets it\n",
        1000 * delay.value, error);
  }
  return fmt::format("depth delay      {:+.0f} +- {:.0f} ms, estimated; --depth-delay sets it\n", used,
                     error);
}

/// Only of a live source, or a replay at its own speed.
std::string live_lines(const RunRecord& record) {
  if (!record.live) return {};
  const LiveCounts& counts = record.live->counts;
  std::string text = fmt::format("live             {} frames came, {:.1f} a second; {} were dropped\n",
                                 counts.arrived, counts.rate(), counts.dropped);
  const auto line = [&](const char* title, const std::optional<Latency>& latency) {
    if (latency)
      text += fmt::format("{:<16} {:.0f} ms until the pose is known, 95 % within {:.0f} ms\n", title,
                          latency->median, latency->most);
  };
  line("from arrival", record.live->from_arrival);
  line("from stamp", record.live->from_stamp);
  return text;
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

double RunRecord::pose_share() const {
  const auto read = static_cast<double>(frames.size() + skipped.size());
  const int lost = count_frames(frames, [](const FrameReport& frame) { return frame.lost(); });
  return (static_cast<double>(frames.size()) - lost) / read;
}

int RunRecord::doubtful_end() const {
  int count = 0;
  for (auto frame = frames.rbegin(); frame != frames.rend() && frame->state != TrackingState::Good; ++frame)
    ++count;
  return count;
}

IterationTotal tracking_total(const std::vector<FrameReport>& frames) {
  return total(frames, &FrameReport::tracking_iterations, &FrameReport::tracking_ms);
}

IterationTotal mapping_total(const std::vector<FrameReport>& frames) {
  return total(frames, &FrameReport::mapping_iterations, &FrameReport::mapping_ms);
}

int count_loops(const std::vector<Loop>& loops) {
  return static_cast<int>(
      std::count_if(loops.begin(), loops.end(), [](const Loop& l) { return l.counts(); }));
}

std::string run_summary(const RunRecord& record) {
  std::string text = frames_line(record);
  text += skipped_lines(record);
  text += live_lines(record);
  text += depth_delay_line(record);
  if (!record.frames.empty())
    text += fmt::format("poses known      {:.1f} % of the frames\n", 100 * record.pose_share());
  text += trajectory_table(record.accuracy);
  if (const int loops = count_loops(record.loops))
    text += fmt::format("places again     {}, {} looked known (loops.csv)\n", loops, record.loops.size());
  text += fmt::format("speed            {:.2f} frames/s, {:.1f} s in all\n", record.frames_per_second(),
                      record.seconds);
  text += cost_line("tracking", tracking_total(record.frames), record.frames.size(), "frame");
  text += cost_line("mapping", mapping_total(record.frames), record.keyframes.size(), "keyframe");
  text += fmt::format("map              {} Gaussians, {:.1f} MB of memory\n", record.gaussians(),
                      static_cast<double>(record.engine.map_bytes) / 1e6);
  if (record.images) text += quality_table(*record.images);
  return text;
}

}  // namespace surefield
