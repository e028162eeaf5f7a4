#include "tools/eval/eval_run.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "engine/eval/mesh_alignment.h"
#include "engine/io/files.h"
#include "engine/sources/open_dataset.h"
#include "engine/types/error.h"
#include "tools/results/run_folder.h"
#include "tools/results/trajectory_report.h"
#include "tools/shared/command.h"
#include "tools/shared/interrupt.h"
#include "tools/shared/numbers.h"
#include "tools/shared/progress.h"

namespace surefield {

namespace {

/// None where the dataset does not know enough poses.
RunAccuracy measure_trajectory(const RunFolder& run, const Dataset& dataset) {
  RunAccuracy errors;
  if (!dataset.ground_truth) return errors;
  try {
    errors.frames = evaluate_trajectory(run.trajectory, *dataset.ground_truth);
    if (run.online) errors.online = evaluate_trajectory(*run.online, *dataset.ground_truth);
  } catch (const InputError& error) {
    fmt::print(stderr, "surefield: note: the trajectory is not measured: {}\n", error.what());
    return errors;
  }
  try {
    errors.keyframes = evaluate_trajectory(run.keyframes, *dataset.ground_truth);
  } catch (const InputError&) {
    // Too few keyframes to compare, which the count of keyframes tells.
  }
  return errors;
}

/// The true poses of other views in the run's world: the dataset's truth, which has theirs in the same world,
/// says where that lies.
std::vector<QualityView> true_views(const RunFolder& run, const Dataset& dataset, const Dataset& views) {
  if (!dataset.ground_truth || !views.ground_truth) {
    const Recording& without = *(dataset.ground_truth ? views : dataset).recording;
    throw InputError("--views needs true poses of both datasets, but " + without.name() + " has none");
  }
  const Intrinsics intrinsics = views.recording->intrinsics();
  const Eigen::Isometry3d to_truth = align_poses(associate(run.trajectory, *dataset.ground_truth));
  const Trajectory truth = of_tracked_camera(*views.ground_truth, *views.recording);
  std::vector<QualityView> result;
  for (int i = 0; i < views.recording->count() && i < static_cast<int>(truth.size()); ++i) {
    if (truth[i].is_finite())
      // Neither keyframes nor held out: no frame of the run.
      result.push_back({i, {intrinsics, truth[i].camera_to_world.inverse() * to_truth}, true});
  }
  return result;
}

std::optional<MapQuality> measure_images(const EvalRunOptions& options, const RunFolder& run,
                                         const Recording& recording, std::vector<QualityView> views,
                                         const Trajectory& trajectory) {
  const double scale = options.scale > 0 ? options.scale : run.number("/dataset/scale");
  for (QualityView& view : views) view.camera.intrinsics = recording.intrinsics().scaled(scale);
  std::optional<Lpips> lpips;
  if (!options.lpips.empty()) lpips.emplace(options.lpips);
  SplatEngine engine(options.engine);
  assign_map(engine, run);
  QualityInput input{.frame = frames_of(recording, scale),
                     .views = std::move(views),
                     .track = PoseTrack(trajectory),
                     .noise = noise_of(settings_of(run).sensor),
                     .render = [&](const Camera& camera) { return engine.render(camera); }};
  if (lpips) input.lpips = &*lpips;
  CountProgress progress("frames compared", static_cast<int>(input.views.size()));
  input.progress = [&](std::size_t done) { progress.reached(static_cast<int>(done)); };
  return measure_map_quality(input);
}

/// Of the map on disk; NaN where there is none.
double file_megabytes(const RunFolder& run) {
  std::error_code error;
  const auto bytes = std::filesystem::file_size(run.map_file(), error);
  return error ? NAN : static_cast<double>(bytes) / 1e6;
}

nlohmann::ordered_json to_json(const RunFolder& run, const RunAccuracy& errors,
                               const std::optional<MapQuality>& images) {
  nlohmann::ordered_json json = {{"schema", "surefield-evaluation"}, {"version", 1}};
  json["trajectory"] = trajectory_json(errors);
  json["images"] = quality_json(images);
  for (const char* part : {"time", "map", "memory"}) json[part] = run.metrics.at(part);
  const double size = file_megabytes(run);
  json["map"]["file_megabytes"] = std::isfinite(size) ? nlohmann::ordered_json(size) : nullptr;
  return json;
}

/// Runtime and memory.
std::string cost_lines(const RunFolder& run) {
  const auto cost = [&](const std::string& what, const char* each, double count) {
    return fmt::format("{:<16} {} ms a {} ({} iterations of {} ms)\n", what,
                       shown(1000 * run.number("/time/" + what + "_s") / count, 1), each,
                       shown(run.number("/time/" + what + "_iterations") / count, 1),
                       shown(run.number("/time/" + what + "_ms_per_iteration"), 2));
  };
  std::string text = cost("tracking", "frame", run.number("/frames/fed"));
  text += cost("mapping", "keyframe", run.number("/frames/keyframes"));
  text += fmt::format("speed            {} frames/s\n", shown(run.number("/time/frames_per_second"), 2));
  text += fmt::format("map              {} MB of memory, {} {} MB\n", shown(run.number("/map/megabytes"), 1),
                      run.map_file().filename().string(), shown(file_megabytes(run), 1));
  text += fmt::format("memory           device {} MB, host {} MB\n",
                      shown(run.number("/memory/device_peak_mb"), 1),
                      shown(run.number("/memory/host_peak_mb"), 1));
  return text;
}

}  // namespace

int evaluate_run(const EvalRunOptions& options) {
  catch_interrupts();
  const RunFolder run = read_run(options.run);
  const Dataset dataset = open_dataset_of(run, options.dataset);
  const RunAccuracy errors = measure_trajectory(run, dataset);
  const std::optional<MapQuality> images =
      measure_images(options, run, *dataset.recording, views_of(run, *dataset.recording),
                     of_tracked_camera(run.trajectory, *dataset.recording));
  std::optional<MapQuality> views;
  if (!options.views.empty()) {
    const Dataset other = open_dataset(options.views);
    views = measure_images(options, run, *other.recording, true_views(run, dataset, other), {});
  }
  if (!options.json.empty()) {
    auto json = to_json(run, errors, images);
    if (!options.views.empty()) json["views"] = quality_json(views);
    write_file(options.json, [&](std::ostream& stream) { stream << json.dump(2) << "\n"; });
  }
  fmt::print("{}", trajectory_table(errors));
  if (images) fmt::print("{}", quality_table(*images));
  if (views) fmt::print("from the views of {}\n{}", options.views, quality_table(*views));
  fmt::print("{}", cost_lines(run));
  return interrupted() ? kInterrupted : kSuccess;
}

}  // namespace surefield
