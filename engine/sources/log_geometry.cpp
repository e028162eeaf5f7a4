// The cameras of a log, and where the depth camera stands beside the colour camera.
#include "engine/sources/log_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/io/files.h"
#include "engine/io/images.h"
#include "engine/sources/layouts.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr double kSamePixels = 0.5;  // by which intrinsics of registered images may differ

/// A model and coefficients as CameraInfo has them. RealSense's SDK has names of its own; its inverse model
/// goes the other way, from the distorted pixel to the straight one, and is not read unless its numbers are
/// 0.
LensDistortion lens_of(const CameraInfoMessage& info, const std::string& topic,
                       std::vector<std::string>& warnings) {
  LensDistortion lens;
  lens.coefficients = info.distortion;
  const bool straight =
      std::all_of(info.distortion.begin(), info.distortion.end(), [](double k) { return k == 0; });
  const bool fisheye =
      info.model == "equidistant" || info.model == "fisheye" || info.model == "Kannala Brandt4";
  if (fisheye && lens.coefficients.size() >= 4) {
    lens.model = LensDistortion::Model::Fisheye;
    lens.coefficients.resize(4);
    return lens;
  }
  if (straight) return {};
  const bool known =
      info.model == "plumb_bob" || info.model == "rational_polynomial" || info.model == "Brown Conrady";
  constexpr std::array<std::size_t, 5> kSizes = {4, 5, 8, 12, 14};
  if (known && std::find(kSizes.begin(), kSizes.end(), lens.coefficients.size()) != kSizes.end()) return lens;
  warnings.push_back(
      fmt::format("{}: a distortion \"{}\" of {} numbers is not known and not corrected; --assume-camera "
                  "names a camera",
                  topic, info.model, info.distortion.size()));
  return {};
}

/// Whether the images were rectified: their camera is then P, without distortion.
bool is_rectified(const std::string& image_topic) {
  std::string name = image_topic;
  for (const char* transport : {"/compressed", "/compressedDepth"})
    if (name.ends_with(transport)) name = name.substr(0, name.find_last_of('/'));
  return name.substr(name.find_last_of('/') + 1).find("rect") != std::string::npos;
}

/// The camera of an image topic that has a CameraInfo. Where that is for another size of the same shape, it
/// is scaled.
RecordedCamera camera_of(const LogImageTopic& image, LogCameras& found) {
  const CameraInfoMessage& info = *image.camera;
  RecordedCamera camera;
  Intrinsics& k = camera.intrinsics;
  k = {static_cast<int>(std::min(info.width, uint32_t{kLargestSide})),
       static_cast<int>(std::min(info.height, uint32_t{kLargestSide})),
       info.intrinsics[0],
       info.intrinsics[4],
       info.intrinsics[2],
       info.intrinsics[5]};
  if (is_rectified(image.name) && info.projection[0] > 0) {
    k.fx = info.projection[0];
    k.fy = info.projection[5];
    k.cx = info.projection[2];
    k.cy = info.projection[6];
  } else {
    camera.distortion = lens_of(info, image.camera_topic, found.warnings);
  }
  if (!std::isfinite(k.fx + k.fy + k.cx + k.cy) || !(k.fx > 0) || !(k.fy > 0))
    throw InputError(image.camera_topic, "says no focal length; --assume-camera names a camera");
  if (k.width == 0 || k.height == 0) {
    k.width = image.size.width;
    k.height = image.size.height;
  }
  if (image.size.empty() || (k.width == image.size.width && k.height == image.size.height)) return camera;
  const double scale = static_cast<double>(image.size.width) / k.width;
  if (std::abs(scale * k.height - image.size.height) > 1) {
    throw InputError(
        image.camera_topic,
        fmt::format("is for {} x {} pixels, the images of {} have {} x {}; --assume-camera names a camera",
                    k.width, k.height, image.name, image.size.width, image.size.height));
  }
  found.assumptions.push_back(fmt::format("{} is for {} x {} pixels and was scaled to {} x {}",
                                          image.camera_topic, k.width, k.height, image.size.width,
                                          image.size.height));
  k = k.scaled(scale);
  k.width = image.size.width;
  k.height = image.size.height;
  return camera;
}

/// The transform that a topic of extrinsics tells, where one is named for the way from depth to colour.
std::optional<Eigen::Isometry3d> from_extrinsics_topic(const LogReader& log) {
  for (uint16_t topic = 0; topic < log.topics().size(); ++topic) {
    const LogTopic& known = log.topics()[topic];
    const bool named =
        known.name.ends_with("extrinsics/depth_to_color") && known.type.ends_with("/Extrinsics");
    const auto message = named ? log.first(topic) : std::nullopt;
    if (message) return read_extrinsics(message->view());
  }
  return std::nullopt;
}

/// RealSense's SDK stores with each stream the transform from a stream that all have in common.
std::optional<Eigen::Isometry3d> from_sdk_topics(const LogReader& log, const LogChoice& choice) {
  constexpr std::string_view kData = "/image/data";
  const auto from_reference = [&](const std::string& image) -> std::optional<Eigen::Isometry3d> {
    if (!image.ends_with(kData)) return std::nullopt;
    const auto topic = log.find(image.substr(0, image.size() - kData.size()) + "/tf/0");
    if (!topic || !log.is(*topic, "geometry_msgs/Transform")) return std::nullopt;
    const auto message = log.first(*topic);
    return message ? std::optional(read_bare_transform(message->view())) : std::nullopt;
  };
  const auto depth = from_reference(choice.depth.name), colour = from_reference(choice.colour.name);
  if (!depth || !colour) return std::nullopt;
  return *colour * depth->inverse();
}

std::optional<Eigen::Isometry3d> depth_to_colour(const LogReader& log, const LogChoice& choice,
                                                 const FrameTree& frames) {
  std::optional<Eigen::Isometry3d> transform = frames.between(choice.depth.frame, choice.colour.frame);
  if (!transform) transform = from_extrinsics_topic(log);
  if (!transform) transform = from_sdk_topics(log, choice);
  if (transform && !transform->matrix().allFinite()) transform.reset();
  return transform;
}

bool same_camera(const Intrinsics& a, const Intrinsics& b) {
  return a.width == b.width && a.height == b.height && std::abs(a.fx - b.fx) < kSamePixels &&
         std::abs(a.fy - b.fy) < kSamePixels && std::abs(a.cx - b.cx) < kSamePixels &&
         std::abs(a.cy - b.cy) < kSamePixels;
}

[[noreturn]] void ask_for_depth_camera(const LogReader& log, const LogChoice& choice, const char* missing) {
  throw InputError(
      log.path(),
      fmt::format("the depth images of {} ({} x {}) are not registered to the colour images of {} ({} x "
                  "{}), and the log has no {}; record the registered depth, or give both cameras in a "
                  "camera.yaml with a section depth, beside the log or by --assume-camera "
                  "(docs/datasets.md)",
                  choice.depth.name, choice.depth.size.width, choice.depth.size.height, choice.colour.name,
                  choice.colour.size.width, choice.colour.size.height, missing));
}

/// Finds out whether depth has a camera of its own, and which.
void find_depth_camera(const LogReader& log, const LogChoice& choice, const FrameTree& frames,
                       LogCameras& found) {
  const bool same_size = choice.depth.size == choice.colour.size;
  if (choice.aligned && same_size) return;
  if (!choice.depth.camera) {
    if (!same_size) ask_for_depth_camera(log, choice, "camera of the depth images (CameraInfo)");
    found.assumptions.push_back(
        fmt::format("{} has no camera of its own and is registered to the colour images", choice.depth.name));
    return;
  }
  const RecordedCamera depth = camera_of(choice.depth, found);
  const auto transform =
      choice.aligned ? Eigen::Isometry3d::Identity() : depth_to_colour(log, choice, frames);
  if (!transform) {
    if (!same_camera(depth.intrinsics, found.camera.intrinsics))
      ask_for_depth_camera(log, choice, "transform from the depth camera to the colour camera (tf_static)");
    found.assumptions.push_back(
        fmt::format("{} has the camera of the colour images and is registered to them", choice.depth.name));
    return;
  }
  if (same_camera(depth.intrinsics, found.camera.intrinsics) &&
      transform->isApprox(Eigen::Isometry3d::Identity(), 1e-6))
    return;
  found.camera.depth_camera = RecordedDepthCamera{depth.intrinsics, depth.distortion, *transform};
}

/// Where a bare file is given, its camera.yaml lies beside it.
std::filesystem::path folder_of(const std::filesystem::path& path) {
  return folder_exists(path) ? path : path.parent_path();
}

}  // namespace

FrameTree read_frames_of(const LogReader& log) {
  FrameTree frames;
  for (uint16_t topic = 0; topic < log.topics().size(); ++topic) {
    if (!log.is(topic, "tf2_msgs/TFMessage") && !log.is(topic, "tf/tfMessage")) continue;
    for (const MessagePlace& place : log.places(topic)) {
      try {
        const OwnedMessage message = log.read(place);
        for (const TransformMessage& transform : read_transforms(message.view())) frames.add(transform);
      } catch (const InputError&) {
        continue;  // what a damaged message says, others say again
      }
    }
  }
  return frames;
}

LogCameras find_cameras(const LogReader& log, const LogChoice& choice, const FrameTree& frames,
                        const DatasetOptions& options) {
  LogCameras found;
  found.camera.depth_unit = 0;
  const std::filesystem::path folder = folder_of(log.path());
  if (const auto own = own_camera(folder, options, found.assumptions)) {
    if (options.camera.empty())
      found.assumptions.push_back(fmt::format("the camera is that of {}", (folder / kCameraFile).string()));
    found.camera = *own;
    if (found.camera.intrinsics.width == 0) {
      found.camera.intrinsics.width = choice.colour.size.width;
      found.camera.intrinsics.height = choice.colour.size.height;
    }
    if (!own->depth_camera && choice.depth.size != choice.colour.size)
      throw InputError(
          log.path(),
          fmt::format("the depth images have {} x {} pixels, the colour images {} x {}; the camera that "
                      "is given needs a section depth (docs/datasets.md)",
                      choice.depth.size.width, choice.depth.size.height, choice.colour.size.width,
                      choice.colour.size.height));
    return found;
  }
  if (!choice.colour.camera) {
    throw InputError(
        log.path(),
        fmt::format("nothing says the camera of {}: there is no {} (sensor_msgs/CameraInfo); write a "
                    "camera.yaml beside the log, or name the camera (surefield run --assume-camera)",
                    choice.colour.name, camera_topic_of(choice.colour.name)));
  }
  found.camera = camera_of(choice.colour, found);
  find_depth_camera(log, choice, frames, found);
  return found;
}

}  // namespace surefield
