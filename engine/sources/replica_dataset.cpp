// Replica as rendered for iMAP and NICE-SLAM: results/frame%06d.jpg (or .png), results/depth%06d.png,
// traj.txt, cam_params.json.
#include <fmt/format.h>

#include "engine/io/camera_json.h"
#include "engine/io/files.h"
#include "engine/io/json_file.h"
#include "engine/io/text_file.h"
#include "engine/sources/layouts.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

std::filesystem::path find_calibration(const std::filesystem::path& folder) {
  const std::filesystem::path own = folder / "cam_params.json";
  if (file_exists(own)) return own;
  const std::filesystem::path shared = folder.parent_path() / "cam_params.json";
  if (file_exists(shared)) return shared;
  throw InputError(folder,
                   "cam_params.json is missing, here and in the parent folder; it comes with the dataset");
}

/// Row n of traj.txt is the pose of frame n: 4 x 4, row by row, camera to world.
Trajectory read_rows_of_poses(const std::filesystem::path& file) {
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
  return !numbered_images(folder / "results", {"frame"}).empty();
}

StoredSequence read_replica_sequence(const std::filesystem::path& folder, const DatasetOptions& options) {
  StoredSequence sequence;
  sequence.name = folder.filename().string();
  sequence.format = "replica";
  const std::filesystem::path images = folder / "results";
  sequence.frames =
      numbered_frames({numbered_images(images, {"frame"}), numbered_images(images, {"depth"}),
                       [&](int number) { return images / fmt::format("frame{:06}.jpg", number); },
                       [&](int number) { return images / fmt::format("depth{:06}.png", number); }});
  if (const auto own = own_camera(folder, options, sequence.assumptions)) {
    use_camera(*own, sequence);
  } else {
    const JsonObject camera = JsonObject(find_calibration(folder)).object("camera");
    sequence.intrinsics = read_intrinsics(camera, "w", "h");
    sequence.depth_encoding.unit = 1 / camera.positive("scale");
  }
  const std::filesystem::path truth = folder / "traj.txt";
  if (file_exists(truth)) read_truth(sequence, [&] { return read_rows_of_poses(truth); });
  return sequence;
}

}  // namespace surefield
