// The camera that the user gives wins over what a layout implies.
#include <fmt/format.h>

#include <algorithm>

#include "engine/io/files.h"
#include "engine/sources/layouts.h"

namespace surefield {

std::optional<RecordedCamera> own_camera(const std::filesystem::path& folder, const DatasetOptions& options,
                                         std::vector<std::string>& assumptions) {
  if (!options.camera.empty()) {
    const std::vector<std::string> names = known_camera_names();
    const bool known = std::find(names.begin(), names.end(), options.camera) != names.end();
    assumptions.push_back(fmt::format("the camera is that of {}, as asked for", options.camera));
    return known ? known_camera(options.camera) : read_camera_file(options.camera);
  }
  if (!file_exists(folder / kCameraFile)) return std::nullopt;
  return read_camera_file(folder / kCameraFile);
}

void use_camera(const RecordedCamera& camera, StoredSequence& sequence) {
  sequence.intrinsics = camera.intrinsics;
  sequence.distortion = camera.distortion;
  sequence.depth_encoding.unit = camera.depth_unit;
  sequence.registration.reset();
  sequence.depth_distortion = {};
  sequence.tracked_to_reference = Pose::Identity();
  if (camera.depth_camera) {
    sequence.registration = DepthRegistration{camera.depth_camera->intrinsics, camera.intrinsics,
                                              camera.depth_camera->depth_to_colour};
    sequence.depth_distortion = camera.depth_camera->distortion;
  }
  if (sequence.intrinsics.width > 0) return;
  const cv::Size size = stored_size(sequence.frames);
  sequence.intrinsics.width = size.width;
  sequence.intrinsics.height = size.height;
  sequence.assumptions.push_back(fmt::format(
      "the calibration is for images of {} x {} pixels, as the first one has", size.width, size.height));
}

std::vector<double> stamps_of(const StoredSequence& sequence) {
  std::vector<double> stamps;
  for (const StoredFrame& frame : sequence.frames) stamps.push_back(frame.timestamp);
  return stamps;
}

}  // namespace surefield
