#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/slam/settings.h"
#include "engine/sources/open_dataset.h"
#include "engine/splat/engine.h"
#include "engine/viewer/up_direction.h"
#include "tools/results/map_quality.h"

namespace surefield {

/// The results of a run, as `surefield run` left them in a folder.
struct RunFolder {
  std::filesystem::path path;
  std::string name;                  ///< of the folder
  nlohmann::json metrics;            ///< metrics.json, checked for its schema
  Trajectory trajectory;             ///< one pose per entry of metrics["per_frame"]
  std::optional<Trajectory> online;  ///< as the poses were when each frame came; none of an older run
  Trajectory keyframes;
  std::string configuration;  ///< config.yaml

  /// The file of the map: map.ply, or map.spz where there is none.
  std::filesystem::path map_file() const;

  /// The number at a JSON pointer into metrics such as "/time/total_s"; NaN where it is missing or null.
  double number(const std::string& pointer) const;
  /// The text at a JSON pointer; empty where there is none.
  std::string text(const std::string& pointer) const;
  /// Where up is, as the run was told or found; nullopt where it has not ended.
  std::optional<UpDirection> up() const;
};

/// Reads a folder of results. Throws InputError naming the file that is missing, damaged or of another
/// version.
RunFolder read_run(const std::filesystem::path& folder);

/// The settings that a run had. Throws InputError.
SlamSettings settings_of(const RunFolder& run);

/// Puts the map of a run into an engine, with the depth of a Gaussian over its footprint that the run had.
/// Throws InputError.
void assign_map(SplatEngine& engine, const RunFolder& run);

/// Opens the dataset that the run was made from, or `instead` where that is not empty. Throws InputError.
Dataset open_dataset_of(const RunFolder& run, const std::string& instead = "");

/// The views of all frames of a run that were not lost, with the intrinsics that its images had.
std::vector<QualityView> views_of(const RunFolder& run, const Recording& recording);

}  // namespace surefield
