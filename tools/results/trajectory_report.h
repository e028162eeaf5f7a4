#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "engine/eval/trajectory_metrics.h"

namespace surefield {

/// Trajectory errors as docs/evaluation.md describes them: metres and radians.
nlohmann::ordered_json trajectory_json(const TrajectoryMetrics& metrics);

/// Errors of one run's trajectories; each is known where there is truth, and enough poses.
struct RunAccuracy {
  std::optional<TrajectoryMetrics> frames;     ///< all, as the run has left them
  std::optional<TrajectoryMetrics> online;     ///< all, each as it was when it came
  std::optional<TrajectoryMetrics> keyframes;  ///< alone, as the run has left them
};

/// Those of all frames, with the ATE of the others; null where there are none.
nlohmann::ordered_json trajectory_json(const RunAccuracy& accuracy);

/// The same as lines for people, in centimetres and degrees.
std::string trajectory_table(const TrajectoryMetrics& metrics);

/// The same of all frames, with the ATE of the others; empty where there is none.
std::string trajectory_table(const RunAccuracy& accuracy);

}  // namespace surefield
