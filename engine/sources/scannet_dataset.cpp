// ScanNet as exported from its .sens files: color/%d.jpg, depth/%d.png, pose/%d.txt, intrinsic/. The images
// are registered to each other; the frame is the depth image, to which colour is averaged down.
#include <fmt/format.h>

#include <opencv2/core.hpp>

#include "engine/io/files.h"
#include "engine/io/text_file.h"
#include "engine/sources/layouts.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

Intrinsics read_intrinsics_matrix(const std::filesystem::path& file, cv::Size size) {
  const auto m = read_numbers(file);
  if (!m || m->size() != 16 || !((*m)[0] > 0) || !((*m)[5] > 0)) {
    throw InputError(file, "expected a 4 x 4 matrix of intrinsics (16 numbers, fx and fy positive)");
  }
  return {size.width, size.height, (*m)[0], (*m)[5], (*m)[2], (*m)[6]};
}

/// The poses of those frames that have a file, however its number is spelt; one with -inf is unknown, and so
/// not finite.
Trajectory read_poses(const std::filesystem::path& folder, const StoredSequence& sequence) {
  const auto files = numbered_files(folder / "pose", {}, ".txt");
  Trajectory truth;
  for (const StoredFrame& frame : sequence.frames) {
    const auto file = files.find(static_cast<int>(frame.timestamp));
    if (file == files.end()) continue;
    const auto numbers = read_numbers(file->second);
    const auto pose = numbers ? rigid_from_rows(*numbers) : std::nullopt;
    if (!pose) throw InputError(file->second, "expected a rigid 4 x 4 camera-to-world matrix (16 numbers)");
    truth.push_back({frame.timestamp, *pose});
  }
  return truth;
}

}  // namespace

bool is_scannet(const std::filesystem::path& folder) {
  return folder_exists(folder / "color") && folder_exists(folder / "depth") &&
         folder_exists(folder / "intrinsic");
}

StoredSequence read_scannet_sequence(const std::filesystem::path& folder, const DatasetOptions& options) {
  StoredSequence sequence;
  sequence.name = folder.filename().string();
  sequence.format = "scannet";
  sequence.frames =
      numbered_frames({numbered_images(folder / "color", {}), numbered_images(folder / "depth", {}),
                       [&](int number) { return folder / "color" / fmt::format("{}.jpg", number); },
                       [&](int number) { return folder / "depth" / fmt::format("{}.png", number); },
                       /*fill_gaps=*/false});
  if (sequence.frames.empty())
    throw InputError(folder, "color/ and depth/ hold no image that is named by a number");
  sequence.resize_colour = true;
  if (const auto own = own_camera(folder, options, sequence.assumptions)) {
    use_camera(*own, sequence);
  } else {
    sequence.intrinsics =
        read_intrinsics_matrix(folder / "intrinsic" / "intrinsic_depth.txt", stored_size(sequence.frames));
    sequence.depth_encoding.unit = kMillimetre;
    sequence.assumptions.push_back("depth is in millimetres, as ScanNet has it");
  }
  read_truth(sequence, [&] { return read_poses(folder, sequence); });
  return sequence;
}

}  // namespace surefield
