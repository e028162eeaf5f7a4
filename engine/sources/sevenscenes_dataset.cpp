// 7-Scenes: frame-%06d.color.png (or .jpg), frame-%06d.depth.png, frame-%06d.pose.txt in one folder. Colour
// and depth come from two cameras; depth is registered to the colour camera, which is the tracked one. The
// poses describe the depth camera.
#include <fmt/format.h>

#include "engine/io/text_file.h"
#include "engine/sources/layouts.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr Intrinsics kDepthCamera = {640, 480, 585, 585, 320, 240};
// On RedKitchen the edges of depth and colour agree better with the centre at 326, 242, but tracking is
// worse.
constexpr Intrinsics kColourCamera = {640, 480, 525, 525, 320, 240};
constexpr DepthEncoding kDepthEncoding = {0.001, 65535};
const NumberedName kColourName = {"frame-", ".color"};
const NumberedName kDepthName = {"frame-", ".depth"};
const NumberedName kPoseName = {"frame-", ".pose"};

/// The published calibration of the Kinect that recorded the sequences.
Eigen::Isometry3d depth_to_colour() {
  return *rigid_from_rows({0.999965180, 0.002676513, -0.007904101, -0.025558943,  //
                           -0.002740931, 0.999963028, -0.008150452, 0.000101096,  //
                           0.007881994, 0.008171833, 0.999935546, 0.002031832,    //
                           0, 0, 0, 1});
}

/// A pose file holds a 4 x 4 camera-to-world matrix.
StampedPose read_pose(int number, const std::filesystem::path& file) {
  const auto numbers = read_numbers(file);
  const auto pose = numbers ? rigid_from_rows(*numbers) : std::nullopt;
  if (!pose) throw InputError(file, "expected a rigid 4 x 4 camera-to-world matrix (16 numbers)");
  return {static_cast<double>(number), *pose};
}

}  // namespace

bool is_sevenscenes(const std::filesystem::path& folder) {
  return !numbered_images(folder, kColourName).empty();
}

StoredSequence read_sevenscenes_sequence(const std::filesystem::path& folder, const DatasetOptions& options) {
  StoredSequence sequence;
  sequence.name = folder.filename().string();
  sequence.format = "sevenscenes";
  sequence.frames =
      numbered_frames({numbered_images(folder, kColourName), numbered_images(folder, kDepthName),
                       [&](int number) { return folder / fmt::format("frame-{:06}.color.png", number); },
                       [&](int number) { return folder / fmt::format("frame-{:06}.depth.png", number); }});
  sequence.intrinsics = kColourCamera;
  sequence.registration = DepthRegistration{kDepthCamera, kColourCamera, depth_to_colour()};
  sequence.tracked_to_reference = depth_to_colour().inverse();
  sequence.depth_encoding = kDepthEncoding;
  if (const auto own = own_camera(folder, options, sequence.assumptions)) {
    use_camera(*own, sequence);
  } else {
    sequence.assumptions.push_back(
        "colour and depth camera are those of 7-Scenes' Kinect, and depth is registered to colour; a "
        "camera.yaml of "
        "your own, for depth that is registered already, goes before");
  }
  read_truth(sequence, [&] {
    Trajectory truth;
    for (const auto& [number, file] : numbered_files(folder, kPoseName, ".txt"))
      truth.push_back(read_pose(number, file));
    return truth;
  });
  return sequence;
}

}  // namespace surefield
