#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/sources/log_images.h"
#include "engine/sources/log_reader.h"
#include "engine/sources/open_dataset.h"

namespace surefield {

/// A topic with images, as its first message has them.
struct LogImageTopic {
  uint16_t topic = 0;
  std::string name;
  bool compressed = false;  ///< sensor_msgs/CompressedImage
  LogPixels pixels = LogPixels::Unknown;
  std::string encoding;  ///< or format, where it is compressed
  std::string frame;     ///< that of the camera
  cv::Size size;
  std::optional<CameraInfoMessage> camera;
  std::string camera_topic;  ///< that of `camera`
};

/// The topics of a recording.
struct LogChoice {
  LogImageTopic colour;
  LogImageTopic depth;
  bool aligned = false;  ///< whether the depth images are registered to the colour images already
  std::vector<std::string> assumptions;  ///< where there were others to choose
};

/// Chooses colour and depth by type, camera and name, or as the options say. Throws InputError where the log
/// has none, or not the topics that the options name.
LogChoice choose_topics(const LogReader& log, const DatasetOptions& options);

/// The name of the topic that describes the camera of an image topic: its sibling, camera_info; RealSense's
/// SDK has info/camera_info beside image/data.
std::string camera_topic_of(const std::string& image_topic);

}  // namespace surefield
