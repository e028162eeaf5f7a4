#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "engine/slam/slam.h"

namespace surefield {

/// loops.csv: a line of names, then one for every place that looked known; docs/evaluation.md describes the
/// columns. `frames` are the Frame::index of the keyframes.
std::string loops_csv(const std::vector<Loop>& loops, const std::vector<int>& frames);

/// A line of loops.csv.
struct StoredLoop {
  /// Between keyframes by their Frame::index. Of a loop that was not accepted only these are read; the
  /// information is zero where the file has no column for it.
  RelativePose measured{0, 0, Pose::Identity(), Matrix6::Zero()};
  bool accepted = false;
  std::string why;  ///< name_of() the verdict; empty where the file does not say
  // Not a number where the file has no such column.
  double similarity = kUnsaid;
  double overlap = kUnsaid;
  double see_through = kUnsaid;
  double correction_m = kUnsaid;
  double correction_deg = kUnsaid;

  static constexpr double kUnsaid = std::numeric_limits<double>::quiet_NaN();
};

/// Reads loops.csv by the names of its columns; other columns may stand there too. Throws InputError with the
/// line that is damaged, or where there is no such file.
std::vector<StoredLoop> read_loops(const std::filesystem::path& file);

}  // namespace surefield
