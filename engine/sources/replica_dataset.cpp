// Replica as rendered for iMAP and NICE-SLAM: results/frame%06d.jpg (or .png), results/depth%06d.png,
// traj.txt, cam_params.json.
#include "engine/io/camera_json.h"
#include "engine/io/files.h"
#include "engine/io/json_file.h"
#include "engine/sources/layouts.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

std::filesystem::path find_calibration(const std::filesystem::path& folder) {
  const std::filesystem::path own = folder / "cam_params.json";
  if (std::filesystem::exists(own)) return own;
  const std::filesystem::path shared = folder.parent_path() / "cam_params.json";
  if (std::filesystem::exists(shared)) return shared;
  throw InputError(folder,
                   "cam_params.json is missing, here and in the parent folder; it comes with the dataset");
}

/// Row n of traj.txt is the pose of frame n: 4 x 4, row by row, camera to world.
Trajectory read_rows(const std::filesystem::path& file) {
  Trajectory trajectory;
  for (const TextLine& line : read_lines(file)) {
    const auto numbers = parse_numbers(line.text);
    const auto pose = numbers ? rigid_from_rows(*numbers) : std::nullopt;
    if (!pose)
      throw InputError(file, line.number, "expected a rigid 4 x 4 camera-to-world matrix (16 numbers)");
    trajectory.push_back({static_cast<double>(trajectory.size()), *pose});
  }
  return trajectory;
}

}  // namespace

bool is_replica(const std::filesystem::path& folder) {
  return !numbered_files(folder / "results", "frame", image_suffix(folder / "results", "frame")).empty();
}

StoredSequence read_replica_sequence(const std::filesystem::path& folder) {
  StoredSequence sequence;
  sequence.name = folder.filename().string();
  sequence.format = "replica";
  const JsonObject camera = JsonObject(find_calibration(folder)).object("camera");
  sequence.intrinsics = read_intrinsics(camera, "w", "h");
  sequence.depth_encoding.unit = 1 / camera.positive("scale");
  sequence.frames = numbered_frames(folder / "results", {"frame", image_suffix(folder / "results", "frame")},
                                    {"depth", ".png"});
  const std::filesystem::path truth = folder / "traj.txt";
  if (std::filesystem::exists(truth)) sequence.ground_truth = read_rows(truth);
  return sequence;
}

}  // namespace surefield
