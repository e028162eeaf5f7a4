// 7-Scenes: frame-%06d.color.png (or .jpg), frame-%06d.depth.png, frame-%06d.pose.txt in one folder. Colour
// and depth come from two cameras; depth is registered to the colour camera, which is the tracked one. The
// poses describe the depth camera.
#include <fmt/format.h>

#include "engine/io/files.h"
#include "engine/sources/layouts.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr Intrinsics kDepthCamera = {640, 480, 585, 585, 320, 240};
// On RedKitchen the edges of depth and colour agree better with the centre at 326, 242, but tracking is
// worse.
constexpr Intrinsics kColourCamera = {640, 480, 525, 525, 320, 240};
constexpr DepthEncoding kDepthEncoding = {0.001, 65535};
constexpr const char* kPrefix = "frame-";

/// The published calibration of the Kinect that recorded the sequences.
Eigen::Isometry3d depth_to_colour() {
  return *rigid_from_rows({0.999965180, 0.002676513, -0.007904101, -0.025558943,  //
                           -0.002740931, 0.999963028, -0.008150452, 0.000101096,  //
                           0.007881994, 0.008171833, 0.999935546, 0.002031832,    //
                           0, 0, 0, 1});
}

/// A pose file holds a 4 x 4 camera-to-world matrix.
StampedPose read_pose(int number, const std::filesystem::path& file) {
  const auto numbers = parse_numbers(read_file(file));
  const auto pose = numbers ? rigid_from_rows(*numbers) : std::nullopt;
  if (!pose) throw InputError(file, "expected a rigid 4 x 4 camera-to-world matrix (16 numbers)");
  return {static_cast<double>(number), *pose};
}

}  // namespace

bool is_sevenscenes(const std::filesystem::path& folder) {
  return !numbered_files(folder, kPrefix, image_suffix(folder, kPrefix, ".color")).empty();
}

StoredSequence read_sevenscenes_sequence(const std::filesystem::path& folder) {
  StoredSequence sequence;
  sequence.name = folder.filename().string();
  sequence.format = "sevenscenes";
  sequence.intrinsics = kColourCamera;
  sequence.registration = DepthRegistration{kDepthCamera, kColourCamera, depth_to_colour()};
  sequence.tracked_to_reference = depth_to_colour().inverse();
  sequence.depth_encoding = kDepthEncoding;
  sequence.frames =
      numbered_frames(folder, {kPrefix, image_suffix(folder, kPrefix, ".color")}, {kPrefix, ".depth.png"});
  Trajectory truth;
  for (const auto& [number, file] : numbered_files(folder, kPrefix, ".pose.txt")) {
    truth.push_back(read_pose(number, file));
  }
  if (!truth.empty()) sequence.ground_truth = std::move(truth);
  return sequence;
}

}  // namespace surefield
