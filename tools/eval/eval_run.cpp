#include "tools/eval/eval_run.h"

#include <fmt/format.h>

#include "engine/io/files.h"
#include "engine/types/error.h"
#include "tools/results/run_folder.h"
#include "tools/results/trajectory_report.h"
#include "tools/shared/command.h"
#include "tools/shared/interrupt.h"
#include "tools/shared/progress.h"

namespace surefield {

namespace {

/// The errors of all frames and of the keyframes; none where the dataset does not know enough poses.
struct TrajectoryErrors {
  std::optional<TrajectoryMetrics> frames;
  std::optional<TrajectoryMetrics> keyframes;
};

TrajectoryErrors measure_trajectory(const RunFolder& run, const Dataset& dataset) {
  const auto measure = [&](const Trajectory& estimate) -> std::optional<TrajectoryMetrics> {
    if (!dataset.ground_truth) return std::nullopt;
    try {
      return evaluate_trajectory(estimate, *dataset.ground_truth);
    } catch (const InputError&) {
      return std::nullopt;  // too few poses to compare
    }
  };
  return {measure(run.trajectory), measure(run.keyframes)};
}

std::optional<MapQuality> measure_images(const EvalRunOptions& options, const RunFolder& run,
                                         const Recording& recording) {
  std::optional<Lpips> lpips;
  if (!options.lpips.empty()) lpips.emplace(options.lpips);
  SplatEngine engine(options.engine);
  assign_map(engine, run);
  QualityInput input{.frame = frames_of(recording, run.number("/dataset/scale")),
                     .views = views_of(run, recording),
                     .depth_max = run.number("/dataset/depth_max_m"),
                     .render = [&](const Camera& camera) { return engine.render(camera); }};
  if (lpips) input.lpips = &*lpips;
  CountProgress progress("frames compared", static_cast<int>(input.views.size()));
  input.progress = [&](std::size_t done) { progress.reached(static_cast<int>(done)); };
  return measure_map_quality(input);
}

nlohmann::ordered_json to_json(const RunFolder& run, const TrajectoryErrors& errors,
                               const std::optional<MapQuality>& images) {
  nlohmann::ordered_json json = {{"schema", "surefield-evaluation"}, {"version", 1}};
  json["trajectory"] = trajectory_json(errors.frames, errors.keyframes);
  json["images"] = quality_json(images);
  for (const char* part : {"time", "map", "memory"}) json[part] = run.metrics.at(part);
  return json;
}

/// Runtime and memory, as in the paper's table.
std::string cost_lines(const RunFolder& run) {
  const double frames = run.number("/frames/fed"), keyframes = run.number("/frames/keyframes");
  std::string text;
  text += fmt::format("tracking         {:.2f} ms x {:.1f} iterations a frame\n",
                      run.number("/time/tracking_ms_per_iteration"),
                      run.number("/time/tracking_iterations") / frames);
  text += fmt::format("mapping          {:.2f} ms x {:.1f} iterations a keyframe\n",
                      run.number("/time/mapping_ms_per_iteration"),
                      run.number("/time/mapping_iterations") / keyframes);
  text += fmt::format("speed            {:.2f} frames/s\n", run.number("/time/frames_per_second"));
  text += fmt::format("memory           map {:.1f} MB, device {:.1f} MB, host {:.1f} MB\n",
                      run.number("/map/megabytes"), run.number("/memory/device_peak_mb"),
                      run.number("/memory/host_peak_mb"));
  return text;
}

}  // namespace

int evaluate_run(const EvalRunOptions& options) {
  catch_interrupts();
  const RunFolder run = read_run(options.run);
  const Dataset dataset = open_dataset_of(run, options.dataset);
  const TrajectoryErrors errors = measure_trajectory(run, dataset);
  const std::optional<MapQuality> images = measure_images(options, run, *dataset.recording);
  if (!options.json.empty()) {
    const auto json = to_json(run, errors, images);
    write_file(options.json, [&](std::ostream& stream) { stream << json.dump(2) << "\n"; });
  }
  if (errors.frames) fmt::print("{}", trajectory_table(*errors.frames));
  if (errors.keyframes) fmt::print("keyframes' ATE   {:.3f} cm\n", 100 * errors.keyframes->ate.rmse);
  if (images) fmt::print("{}", quality_table(*images));
  fmt::print("{}", cost_lines(run));
  return interrupted() ? kInterrupted : kSuccess;
}

}  // namespace surefield
