#include "tools/results/run_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "engine/formats/map_file.h"
#include "engine/io/files.h"
#include "engine/io/trajectory_file.h"
#include "engine/types/error.h"
#include "tools/results/run_configuration.h"
#include "tools/results/run_files.h"
#include "tools/shared/load_map.h"

namespace surefield {

namespace {

constexpr const char* kSchema = "surefield-metrics";
constexpr int kMetricsVersion = 1;

nlohmann::json read_metrics(const std::filesystem::path& file) {
  if (!file_exists(file)) {
    const std::filesystem::path partial = file.parent_path().string() + ".partial";
    if (file_exists(partial / file.filename()))
      throw InputError(
          file,
          "no such file; the run has not ended, or was ended by force: what it has saved so far is in " +
              partial.string());
    throw InputError(file, "no such file; is this a folder that surefield run has written?");
  }
  nlohmann::json json = nlohmann::json::parse(read_file(file), nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || json.value("schema", nlohmann::json()) != kSchema) {
    throw InputError(file, "is no metrics file of surefield run");
  }
  if (json.value("version", nlohmann::json()) != kMetricsVersion) {
    throw InputError(file,
                     fmt::format("has another version than {}; run the sequence again", kMetricsVersion));
  }
  if (!json.contains("per_frame") || !json["per_frame"].is_array()) {
    throw InputError(file, "says nothing about its frames; run the sequence again");
  }
  return json;
}

/// What a run saves on its way is not swapped as a whole: where it was ended in the middle, its files may be
/// some frames apart.
void cut_to_common_length(RunFolder& run) {
  nlohmann::json& frames = run.metrics["per_frame"];
  const std::size_t common = std::min(run.trajectory.size(), frames.size());
  run.trajectory.resize(common);
  frames.erase(frames.begin() + static_cast<std::ptrdiff_t>(common), frames.end());
  fmt::print(stderr,
             "surefield: note: {}: this run has not ended; these are the {} frames that it has saved\n",
             run.path.string(), common);
}

}  // namespace

std::filesystem::path RunFolder::map_file() const {
  const bool compact =
      !std::filesystem::exists(path / "map.ply") && std::filesystem::exists(path / "map.spz");
  return path / (compact ? "map.spz" : "map.ply");
}

double RunFolder::number(const std::string& pointer) const {
  const nlohmann::json::json_pointer at(pointer);
  if (!metrics.contains(at) || !metrics[at].is_number()) return std::numeric_limits<double>::quiet_NaN();
  return metrics[at].get<double>();
}

std::string RunFolder::text(const std::string& pointer) const {
  const nlohmann::json::json_pointer at(pointer);
  return metrics.contains(at) && metrics[at].is_string() ? metrics[at].get<std::string>() : "";
}

std::optional<UpDirection> RunFolder::up() const {
  const nlohmann::json& direction =
      metrics.value(nlohmann::json::json_pointer("/up/direction"), nlohmann::json());
  if (!direction.is_array() || direction.size() != 3) return std::nullopt;
  UpDirection found;
  for (int axis = 0; axis < 3; ++axis) found.up[axis] = number(fmt::format("/up/direction/{}", axis));
  if (!found.up.allFinite() || found.up.isZero(0)) return std::nullopt;
  found.up = found.up.stableNormalized().eval();
  const auto flag = [&](const char* key) { return metrics["up"].value(key, nlohmann::json()) == true; };
  found.measured = flag("measured");
  found.given = flag("given");
  return found;
}

RunFolder read_run(const std::filesystem::path& folder) {
  RunFolder run;
  run.path = folder;
  const auto whole = std::filesystem::weakly_canonical(folder);
  run.name = (whole.has_filename() ? whole : whole.parent_path()).filename().string();
  run.metrics = read_metrics(folder / "metrics.json");
  run.trajectory = read_trajectory(folder / "trajectory.txt");
  run.keyframes = read_trajectory(folder / "keyframes.txt");
  const std::filesystem::path online = folder / "trajectory_online.txt";
  if (std::filesystem::exists(online)) run.online = read_trajectory(online);
  run.configuration = read_file(folder / "config.yaml");
  check_run_files(run.metrics, folder);
  if (run.text("/status") == "running") cut_to_common_length(run);
  if (run.trajectory.size() != run.metrics["per_frame"].size()) {
    throw InputError(folder / "trajectory.txt",
                     fmt::format("has {} poses, but metrics.json {} frames; the files are of different runs",
                                 run.trajectory.size(), run.metrics["per_frame"].size()));
  }
  return run;
}

SlamSettings settings_of(const RunFolder& run) {
  SlamSettings settings;
  load_settings(settings, {.config = (run.path / "config.yaml").string()}, "");
  return settings;
}

void assign_map(SplatEngine& engine, const RunFolder& run) {
  engine.assign(load_map(run.map_file()), settings_of(run).depth_model);
}

Dataset open_dataset_of(const RunFolder& run, const std::string& instead) {
  RunOptions options;
  options.dataset = instead.empty() ? run.text("/dataset/path") : instead;
  if (options.dataset.empty()) {
    throw InputError(run.path / "metrics.json", "does not name the dataset; give it with --dataset");
  }
  if (instead.empty()) options.format = run.text("/dataset/format");
  options.assumed_camera = run.text("/dataset/assumed_camera");
  const double depth_unit = run.number("/dataset/assumed_depth_unit_m");
  if (std::isfinite(depth_unit)) options.assumed_depth_unit = depth_unit;
  options.colour_topic = run.text("/dataset/colour_topic");
  options.depth_topic = run.text("/dataset/depth_topic");
  const double depth_delay = run.number("/dataset/depth_delay_s");
  if (std::isfinite(depth_delay)) options.depth_delay = depth_delay;
  return open_run_dataset(options);
}

std::vector<QualityView> views_of(const RunFolder& run, const Recording& recording) {
  const Intrinsics intrinsics = recording.intrinsics().scaled(run.number("/dataset/scale"));
  if (intrinsics.width != run.number("/dataset/width") ||
      intrinsics.height != run.number("/dataset/height")) {
    throw InputError(run.path,
                     "was made from images of another size than those of dataset " + recording.name());
  }
  const Trajectory tracked = of_tracked_camera(run.trajectory, recording);
  std::vector<QualityView> views;
  for (std::size_t i = 0; i < tracked.size(); ++i) {
    if (tracked[i].lost) continue;
    const nlohmann::json& frame = run.metrics["per_frame"][i];
    QualityView view{frame.value("index", -1),
                     {intrinsics, tracked[i].camera_to_world.inverse()},
                     frame.value("keyframe", false)};
    if (view.index < 0 || view.index >= recording.count()) {
      throw InputError(run.path, fmt::format("has a frame {}, but dataset {} has {} frames", view.index,
                                             recording.name(), recording.count()));
    }
    views.push_back(view);
  }
  return views;
}

}  // namespace surefield
