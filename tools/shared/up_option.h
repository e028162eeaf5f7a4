#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "engine/viewer/up_direction.h"

namespace surefield {

/// How the user wants it known where up is.
struct UpChoice {
  enum class Way {
    Recorded,  ///< as the run was told or found; where there is no run, by the map
    Map,       ///< by the map, find_up()
    Cameras,   ///< as the cameras were held, up_of()
    Given      ///< by the user
  };
  Way way = Way::Recorded;
  Eigen::Vector3d given = Eigen::Vector3d::Zero();  ///< in the world of the map, unit length, with Way::Given

  bool needs_map(const std::optional<UpDirection>& recorded) const {
    return way == Way::Map || (way == Way::Recorded && !recorded);
  }

  /// Where up is, in the world of a map that the cameras of `trajectory` saw; `recorded` is what is known of
  /// their run. The map may be empty unless needs_map().
  UpDirection of(const GaussianCloud& map, const Trajectory& trajectory,
                 const std::optional<UpDirection>& recorded = std::nullopt) const;
};

/// Adds --up with "auto", "camera" or a direction such as 0,-1,0. `what` tells the user what it turns, and
/// what is taken without it.
CLI::Option* add_up_option(CLI::App& command, UpChoice& choice, const std::string& what);

}  // namespace surefield
