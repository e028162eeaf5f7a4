// ICL-NUIM as published for TUM's tools: rgb/, depth/, associations.txt ("number depth/n.png number
// rgb/n.png"),
// *.gt.freiburg.
//
// The scenes were rendered with y up, fy = -480: poses and intrinsics are those of a mirrored world. The
// images are stored from top to bottom as everywhere, so that with F = diag(1, -1, 1), which turns y down,
// the camera has fy = +480 and a pose P becomes F P F: a rotation again, and the room the right way round.
#include <Eigen/Geometry>
#include <algorithm>
#include <optional>

#include "engine/io/files.h"
#include "engine/io/trajectory_formats.h"
#include "engine/sources/layouts.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr const char* kTruthExtension = ".freiburg";

std::optional<std::filesystem::path> find_truth(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> found;
  for (const std::filesystem::path& file : list_folder(folder))
    if (file.extension() == kTruthExtension) found.push_back(file);
  if (found.size() > 1)
    throw InputError(folder, "holds several *.freiburg trajectories; keep the one that fits");
  if (!found.empty()) return found.front();
  if (file_exists(folder / "groundtruth.txt")) return folder / "groundtruth.txt";
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

bool may_be_icl(const std::filesystem::path& folder) {
  return find_pair_list(folder) && !file_exists(folder / "rgb.txt");
}

bool is_icl(const std::filesystem::path& folder) {
  if (!may_be_icl(folder) || file_exists(folder / kCameraFile)) return false;
  const auto files = list_folder(folder);
  return std::any_of(files.begin(), files.end(),
                     [](const auto& file) { return file.extension() == kTruthExtension; });
}

StoredSequence read_icl_sequence(const std::filesystem::path& folder, const DatasetOptions& options) {
  StoredSequence sequence;
  sequence.name = folder.filename().string();
  sequence.format = "icl";
  sequence.frames = read_pair_list(*find_pair_list(folder), sequence);
  if (const auto camera = own_camera(folder, options, sequence.assumptions)) {
    use_camera(*camera, sequence);
  } else {
    use_camera(known_camera("icl"), sequence);
    sequence.assumptions.push_back("the camera is that of ICL-NUIM, and its world is mirrored (y up)");
  }
  read_truth(sequence, [&] {
    const auto file = find_truth(folder);
    return file ? unmirrored(read_any_trajectory(*file, {.stamps = stamps_of(sequence)}).poses)
                : Trajectory{};
  });
  return sequence;
}

}  // namespace surefield
