// 7-Scenes: frame-%06d.color.png (or .jpg), frame-%06d.depth.png, frame-%06d.pose.txt in one folder. Colour
// and depth come from two cameras that are not registered; both are used with the depth camera's intrinsics,
// which the poses describe.
#include <fmt/format.h>

#include "engine/io/error.h"
#include "engine/io/file_dataset.h"
#include "engine/io/files.h"

namespace surefield {

namespace {

constexpr Intrinsics kDepthCamera = {640, 480, 585, 585, 320, 240};
constexpr DepthEncoding kDepthEncoding = {0.001, 65535};
constexpr const char* kPrefix = "frame-";

/// A pose file holds a 4 x 4 camera-to-world matrix.
StampedPose read_pose(int number, const std::filesystem::path& file) {
  const auto numbers = parse_numbers(read_file(file));
  const auto pose = numbers ? rigid_from_rows(*numbers) : std::nullopt;
  if (!pose) throw InputError(file, "expected a rigid 4 x 4 camera-to-world matrix (16 numbers)");
  return {static_cast<double>(number), *pose};
}

std::string colour_suffix(const std::filesystem::path& folder) {
  return numbered_files(folder, kPrefix, ".color.png").empty() ? ".color.jpg" : ".color.png";
}

}  // namespace

bool is_sevenscenes(const std::filesystem::path& folder) {
  return !numbered_files(folder, kPrefix, colour_suffix(folder)).empty();
}

StoredSequence read_sevenscenes_sequence(const std::filesystem::path& folder) {
  StoredSequence sequence;
  sequence.name = folder.filename().string();
  sequence.format = "sevenscenes";
  sequence.intrinsics = kDepthCamera;
  sequence.depth_encoding = kDepthEncoding;
  sequence.frames = numbered_frames(folder, {kPrefix, colour_suffix(folder)}, {kPrefix, ".depth.png"});
  Trajectory truth;
  for (const auto& [number, file] : numbered_files(folder, kPrefix, ".pose.txt")) {
    truth.push_back(read_pose(number, file));
  }
  if (!truth.empty()) sequence.ground_truth = std::move(truth);
  return sequence;
}

}  // namespace surefield
