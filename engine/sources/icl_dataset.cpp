// ICL-NUIM as published for TUM's tools: rgb/, depth/, associations.txt ("number depth/n.png number
// rgb/n.png"),
// *.gt.freiburg.
//
// The scenes were rendered with y up, fy = -480: poses and intrinsics are those of a mirrored world. The
// images are stored from top to bottom as everywhere, so that with F = diag(1, -1, 1), which turns y down,
// the camera has fy = +480 and a pose P becomes F P F: a rotation again, and the room the right way round.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "engine/io/files.h"
#include "engine/io/trajectory_file.h"
#include "engine/sources/layouts.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr Intrinsics kCamera = {640, 480, 481.2, 480.0, 319.5, 239.5};
constexpr const char* kList = "associations.txt";

/// One line: two stamps, each before its file; which of them is colour, the folders tell.
StoredFrame parse_line(const std::filesystem::path& file, const TextLine& line) {
  std::istringstream text(line.text);
  double stamps[2] = {};
  std::string names[2];
  std::string rest;
  const bool complete = static_cast<bool>(text >> stamps[0] >> names[0] >> stamps[1] >> names[1]);
  const bool colour_first = names[0].starts_with("rgb");
  const bool one_of_each = colour_first != names[1].starts_with("rgb");
  if (!complete || text >> rest || !one_of_each || !std::isfinite(stamps[0]) || !std::isfinite(stamps[1])) {
    throw InputError(file, line.number, "expected \"number depth/n.png number rgb/n.png\"");
  }
  const int colour = colour_first ? 0 : 1;
  return {stamps[colour], file.parent_path() / names[colour], file.parent_path() / names[1 - colour]};
}

std::optional<std::filesystem::path> find_truth(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".freiburg") found.push_back(entry.path());
  }
  if (found.size() > 1)
    throw InputError(folder, "holds several *.freiburg trajectories; keep the one that fits");
  if (!found.empty()) return found.front();
  if (std::filesystem::exists(folder / "groundtruth.txt")) return folder / "groundtruth.txt";
  return std::nullopt;
}

Trajectory unmirrored(Trajectory trajectory) {
  const Eigen::DiagonalMatrix<double, 3> flip(1, -1, 1);
  for (StampedPose& pose : trajectory) {
    pose.camera_to_world.linear() = (flip * pose.camera_to_world.linear() * flip).eval();
    pose.camera_to_world.translation() = (flip * pose.camera_to_world.translation()).eval();
  }
  return trajectory;
}

}  // namespace

bool is_icl(const std::filesystem::path& folder) {
  return std::filesystem::exists(folder / kList) && !std::filesystem::exists(folder / "rgb.txt");
}

StoredSequence read_icl_sequence(const std::filesystem::path& folder) {
  StoredSequence sequence;
  sequence.name = folder.filename().string();
  sequence.format = "icl";
  sequence.intrinsics = kCamera;
  sequence.depth_encoding.unit = kTumDepthUnit;
  for (const TextLine& line : read_lines(folder / kList)) {
    sequence.frames.push_back(parse_line(folder / kList, line));
  }
  if (sequence.frames.empty()) throw InputError(folder / kList, "lists no image");
  std::stable_sort(sequence.frames.begin(), sequence.frames.end(),
                   [](const StoredFrame& a, const StoredFrame& b) { return a.timestamp < b.timestamp; });
  if (const auto truth = find_truth(folder)) sequence.ground_truth = unmirrored(read_trajectory(*truth));
  return sequence;
}

}  // namespace surefield
