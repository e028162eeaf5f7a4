// ScanNet as exported from its .sens files: color/%d.jpg, depth/%d.png, pose/%d.txt, intrinsic/. The images
// are registered to each other; the frame is the depth image, to which colour is averaged down.
#include <fmt/format.h>

#include <charconv>
#include <map>
#include <opencv2/core.hpp>

#include "engine/io/files.h"
#include "engine/sources/layouts.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

/// The images of a folder that are named by whole numbers.
std::map<int, std::filesystem::path> numbered_images(const std::filesystem::path& folder) {
  std::map<int, std::filesystem::path> numbered;
  for (const auto& [stem, file] : images_by_stem(folder)) {
    int number = 0;
    const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
    if (error == std::errc() && end == stem.data() + stem.size() && number >= 0) numbered[number] = file;
  }
  return numbered;
}

/// A frame for each number that has a colour or a depth image; one that lacks the other fails to load.
std::vector<StoredFrame> read_frames(const std::filesystem::path& folder) {
  const auto colours = numbered_images(folder / "color");
  const auto depths = numbered_images(folder / "depth");
  std::map<int, StoredFrame> frames;
  for (const auto& [number, file] : colours) {
    frames[number] = {static_cast<double>(number), file, folder / "depth" / fmt::format("{}.png", number)};
  }
  for (const auto& [number, file] : depths) {
    const auto known = frames.try_emplace(
        number,
        StoredFrame{static_cast<double>(number), folder / "color" / fmt::format("{}.jpg", number), {}});
    known.first->second.depth = file;
  }
  if (frames.empty()) throw InputError(folder, "color/ and depth/ hold no image that is named by a number");
  std::vector<StoredFrame> list;
  for (const auto& [number, frame] : frames) list.push_back(frame);
  return list;
}

Intrinsics read_intrinsics_matrix(const std::filesystem::path& file, cv::Size size) {
  const auto m = parse_numbers(read_file(file));
  if (!m || m->size() != 16 || !((*m)[0] > 0) || !((*m)[5] > 0)) {
    throw InputError(file, "expected a 4 x 4 matrix of intrinsics (16 numbers, fx and fy positive)");
  }
  return {size.width, size.height, (*m)[0], (*m)[5], (*m)[2], (*m)[6]};
}

/// The poses of those frames that have a file; one with -inf is unknown, and so not finite.
Trajectory read_poses(const std::filesystem::path& folder, const std::vector<StoredFrame>& frames) {
  Trajectory truth;
  for (const StoredFrame& frame : frames) {
    const std::filesystem::path file = folder / "pose" / fmt::format("{:.0f}.txt", frame.timestamp);
    if (!std::filesystem::exists(file)) continue;
    const auto numbers = parse_numbers(read_file(file));
    const auto pose = numbers ? rigid_from_rows(*numbers) : std::nullopt;
    if (!pose) throw InputError(file, "expected a rigid 4 x 4 camera-to-world matrix (16 numbers)");
    truth.push_back({frame.timestamp, *pose});
  }
  return truth;
}

}  // namespace

bool is_scannet(const std::filesystem::path& folder) {
  return std::filesystem::is_directory(folder / "color") && std::filesystem::is_directory(folder / "depth") &&
         std::filesystem::is_directory(folder / "intrinsic");
}

StoredSequence read_scannet_sequence(const std::filesystem::path& folder) {
  StoredSequence sequence;
  sequence.name = folder.filename().string();
  sequence.format = "scannet";
  sequence.frames = read_frames(folder);
  sequence.intrinsics =
      read_intrinsics_matrix(folder / "intrinsic" / "intrinsic_depth.txt", stored_size(sequence.frames));
  sequence.depth_encoding.unit = kMillimetre;
  sequence.resize_colour = true;
  Trajectory truth = read_poses(folder, sequence.frames);
  if (!truth.empty()) sequence.ground_truth = std::move(truth);
  return sequence;
}

}  // namespace surefield
