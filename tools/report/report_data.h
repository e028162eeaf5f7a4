#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/eval/trajectory_metrics.h"
#include "tools/results/run_folder.h"

namespace surefield {

/// How far off one frame's pose is: the position after the alignment of positions, the rotation after that of
/// orientations.
struct FrameError {
  int frame = 0;        ///< position among the frames fed
  double position = 0;  ///< metres
  double rotation = 0;  ///< radians
};

/// Everything that a report shows of one run.
struct ReportRun {
  RunFolder folder;
  std::string label;               ///< what the report calls it; no two are the same
  std::optional<Dataset> dataset;  ///< nullopt where it is not there any more
  std::string dataset_problem;     ///< why
  std::optional<TrajectoryMetrics> accuracy;
  std::string truth_problem;    ///< why there is none, where there is a truth
  std::vector<PosePair> pairs;  ///< poses and truths, both in the truth's world
  std::vector<FrameError> errors;
  double path_length = 0;  ///< of the true positions, metres

  /// The entry of metrics.json's per_frame for one frame.
  const nlohmann::json& frame(std::size_t i) const { return folder.metrics["per_frame"][i]; }
  std::size_t frames() const { return folder.trajectory.size(); }
  std::string dataset_name() const { return folder.text("/dataset/name"); }
};

/// Reads the folders of results. A dataset that cannot be opened is noted, not fatal, unless it is given by
/// `dataset`, which stands in for that of every run. Throws InputError.
std::vector<ReportRun> load_report_runs(const std::vector<std::string>& folders, const std::string& dataset);

}  // namespace surefield
