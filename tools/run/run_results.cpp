// What a run leaves behind, and when it is written.
#include "tools/run/run_results.h"

#include <algorithm>

#include "engine/io/files.h"
#include "engine/session/save_run.h"
#include "engine/types/error.h"
#include "tools/results/run_files.h"
#include "tools/shared/interrupt.h"
#include "tools/shared/progress.h"

namespace surefield {

namespace {

constexpr std::size_t kMostCompared = 60;  // frames whose images are compared; surefield eval --run takes all
constexpr int kKeyframesBetween = 5;
constexpr int kRestOfTime = 20;  // times as long as saving takes

void write_text(const std::filesystem::path& file, const std::string& text) {
  write_file(file, [&](std::ostream& stream) { stream << text; });
}

std::optional<TrajectoryMetrics> accuracy(const Trajectory& estimate, const Trajectory* truth) {
  if (!truth) return std::nullopt;
  try {
    return evaluate_trajectory(estimate, *truth);
  } catch (const InputError&) {
    return std::nullopt;  // too few poses to compare
  }
}

/// Adds what SLAM and the ground truth say about a run so far.
void complete_record(RunRecord& record, const Slam& slam, const RunOutput& output) {
  record.frames = slam.reports();
  record.trajectory = slam.trajectory();
  record.online = slam.online_trajectory();
  record.keyframes = slam.keyframes();
  record.loops = slam.loops();
  record.engine = slam.engine_report();
  record.live = output.meter.record();
  const auto errors = [&](const Trajectory& tracked) {
    return accuracy(of_reference_camera(tracked, output.source), output.truth);
  };
  record.accuracy = {errors(record.trajectory), errors(record.online), errors(record.keyframes)};
}

/// The frames that the final map is compared with, by their places among those fed: all that have a pose, or
/// kMostCompared evenly spaced ones where there are more; the kept keyframes where the source cannot be read
/// again.
std::vector<std::size_t> compared_frames(const RunRecord& record, const FrameSource& source,
                                         const KeptKeyframes& kept) {
  std::vector<std::size_t> posed;
  for (std::size_t i = 0; i < record.frames.size(); ++i) {
    const bool again = source.recording() || kept.find(record.frames[i].index);
    if (again && !record.frames[i].lost()) posed.push_back(i);
  }
  if (!source.recording()) return posed;
  const std::size_t count = std::min(posed.size(), kMostCompared);
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < count; ++k)
    places.push_back(posed[count < 2 ? 0 : k * (posed.size() - 1) / (count - 1)]);
  return places;
}

/// Compares the final map with compared_frames().
std::optional<MapQuality> measure_images(const RunRecord& record, const Slam& slam, const FrameSource& source,
                                         const KeptKeyframes& kept) {
  QualityInput input{.frame = {},
                     .views = {},
                     .track = PoseTrack(record.trajectory),
                     .noise = record.noise,
                     .render = [&](const Camera& camera) { return slam.render(camera); }};
  if (source.recording()) {
    input.frame = frames_of(*source.recording(), record.selection.scale);
  } else {
    input.frame = [&](int index) {
      const Frame* frame = kept.find(index);
      return frame ? std::optional(*frame) : std::nullopt;
    };
  }
  for (std::size_t i : compared_frames(record, source, kept))
    input.views.push_back({record.frames[i].index,
                           {record.intrinsics, record.trajectory[i].camera_to_world.inverse()},
                           record.frames[i].keyframe});
  return measure_map_quality(input);
}

/// The last file of a state: it tells what the others hold.
void save_metrics(const RunOutput& output, const RunRecord& record) {
  ResultsFolder& results = output.results;
  results.save("metrics.json", [&](const auto& file) {
    write_text(file, metrics_json(record, run_files_json(results.path(), results.run_id())));
  });
}

}  // namespace

void save_state(const RunOutput& output, RunRecord& record, const Slam& slam) {
  complete_record(record, slam, output);
  output.results.save("config.yaml", [&](const auto& file) { write_text(file, output.configuration); });
  save_run(output.results, slam, output.source, output.map_format);
  save_metrics(output, record);
}

void save_results(const RunOutput& output, RunRecord& record, const Slam& slam, const KeptKeyframes& kept) {
  if (slam.reports().empty()) return;
  ResultsFolder& results = output.results;
  results.forget_problems();  // of checkpoints
  const std::optional<RunEnd> end = record.end;
  if (end == RunEnd::Completed) record.end.reset();  // until the images are measured
  save_state(output, record, slam);
  record.end = end;
  results.save("where up is", [&](const auto&) { record.up = output.up.of(slam.map(), record.trajectory); });
  if (end == RunEnd::Completed) {
    results.save("the image quality",
                 [&](const auto&) { record.images = measure_images(record, slam, output.source, kept); });
    if (interrupted()) record.end = RunEnd::Interrupted;
  }
  save_metrics(output, record);
  results.publish();
}

void Checkpoints::fed(const Frame&, const Slam& slam, const FrameReport& report) {
  keep_until_saved();
  keyframes_ += report.keyframe ? 1 : 0;
  const Clock::time_point begin = Clock::now();
  if (keyframes_ < kKeyframesBetween || begin < next_) return;
  keyframes_ = 0;
  RunRecord record = record_;
  record.seconds = std::chrono::duration<double>(begin - begin_).count();
  record.skipped = skipped_;
  save_state(output_, record, slam);
  output_.results.forget_problems();  // they are in the log, and the disk may have room again
  next_ = Clock::now() + kRestOfTime * (Clock::now() - begin);
}

}  // namespace surefield
