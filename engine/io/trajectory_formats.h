#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/types/trajectory.h"

namespace surefield {

/// How the poses of a file are written; docs/evaluation.md, "Trajectories of other systems", describes each.
enum class TrajectoryFormat { Tum, Kitti, Euroc, Matrices, Bundler, Transforms };

/// All of them by the names that users give them: "tum", "kitti", "euroc", "matrices", "bundler",
/// "transforms".
const std::map<std::string, TrajectoryFormat>& trajectory_formats();

/// The name that users give it.
std::string name_of(TrajectoryFormat format);

/// What a reader is told beside the file.
struct TrajectoryReading {
  std::optional<TrajectoryFormat> format = std::nullopt;  ///< nullopt: told by the content
  /// Seconds; of the poses of a file that has no stamps. Empty: they are numbered from 0.
  std::vector<double> stamps = {};
};

/// A trajectory as it was found in a file.
struct TrajectoryFile {
  Trajectory poses;  ///< camera to world, x right, y down, z forward; unknown poses are not finite
  TrajectoryFormat format = TrajectoryFormat::Tum;
  bool numbered = false;  ///< stamps are only the numbers of the poses, from 0
};

/// Reads a trajectory of any known system. Throws InputError naming the line that cannot be read, where no
/// format fits, where there is no pose, and where `reading.stamps` are needed but are not as many as the
/// poses.
TrajectoryFile read_any_trajectory(const std::filesystem::path& file, const TrajectoryReading& reading = {});

/// The stamps, seconds, of a list: the first number of each line, as in KITTI's times.txt, TUM's rgb.txt or a
/// trajectory. Throws InputError.
std::vector<double> read_stamps(const std::filesystem::path& file);

}  // namespace surefield
