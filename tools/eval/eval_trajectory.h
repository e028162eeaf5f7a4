#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "engine/eval/trajectory_metrics.h"
#include "engine/io/trajectory_formats.h"

namespace surefield {

/// What `surefield eval --trajectory` is asked to do.
struct TrajectoryEvaluation {
  std::string estimate;                    ///< file
  std::string ground_truth;                ///< file, or a dataset
  std::string stamps;                      ///< file with the stamps of poses that have none; empty: see below
  std::optional<TrajectoryFormat> format;  ///< of the estimate; nullopt: told by the content
  Alignment alignment = Alignment::Rigid;
  std::string json;  ///< file to write; empty: none
};

/// Adds the options; returns --trajectory.
CLI::Option* add_trajectory_options(CLI::App& eval, TrajectoryEvaluation& evaluation);

/// Compares two trajectories, prints and writes what docs/evaluation.md describes. Poses without stamps get
/// those of `stamps`, or of the dataset's frames, or of the other trajectory, whichever are as many. Returns
/// the exit code. Throws InputError.
int evaluate_trajectories(const TrajectoryEvaluation& evaluation);

}  // namespace surefield
