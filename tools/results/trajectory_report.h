#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "engine/eval/trajectory_metrics.h"

namespace surefield {

/// Trajectory errors as docs/evaluation.md describes them: metres and radians.
nlohmann::ordered_json trajectory_json(const TrajectoryMetrics& metrics);

/// The errors of all frames with that of the keyframes alone; null where there are none.
nlohmann::ordered_json trajectory_json(const std::optional<TrajectoryMetrics>& frames,
                                       const std::optional<TrajectoryMetrics>& keyframes);

/// The same as lines for people, in centimetres and degrees.
std::string trajectory_table(const TrajectoryMetrics& metrics);

}  // namespace surefield
