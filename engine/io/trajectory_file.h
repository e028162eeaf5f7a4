#pragma once

#include <filesystem>

#include "engine/types/trajectory.h"

namespace surefield {

/// Stands on the line before a pose that is not known, since the camera was lost.
inline constexpr const char* kLostComment = "# lost";

/// Reads a trajectory in TUM format: lines "timestamp tx ty tz qx qy qz qw", camera to world, '#' starts a
/// comment. Quaternions are normalised. A line with NaN or infinity becomes a pose that is not finite. Throws
/// InputError with the line number where a line cannot be read.
Trajectory read_trajectory(const std::filesystem::path& file);

/// Writes a trajectory in TUM format: stamps with 6 decimals, values with 9 significant digits, quaternions
/// with qw >= 0. The same poses give the same bytes. Throws InputError when the file cannot be written.
void write_trajectory(const std::filesystem::path& file, const Trajectory& trajectory);

}  // namespace surefield
