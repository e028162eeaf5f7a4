#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/logs/message_log.h"

namespace surefield {

/// The bytes of one message.
struct SerialisedMessage {
  std::string_view bytes;  ///< what is decoded from it may point into these
  Serialisation serialisation = Serialisation::Cdr;
  std::filesystem::path name;  ///< what errors call it
};

/// std_msgs/Header.
struct MessageHeader {
  double stamp = 0;  ///< seconds, when it was measured
  std::string frame;
};

/// The beginning of sensor_msgs/Image.
struct ImageStart {
  MessageHeader header;
  uint32_t height = 0;
  uint32_t width = 0;
  std::string encoding;
};

/// sensor_msgs/Image.
struct ImageMessage : ImageStart {
  bool big_endian = false;
  uint32_t step = 0;  ///< bytes of a row
  std::string_view data;
};

/// sensor_msgs/CompressedImage.
struct CompressedImageMessage {
  MessageHeader header;
  std::string format;
  std::string_view data;
};

/// sensor_msgs/CameraInfo.
struct CameraInfoMessage {
  MessageHeader header;
  uint32_t height = 0;
  uint32_t width = 0;
  std::string model;                    ///< of the distortion
  std::vector<double> distortion;       ///< D
  std::array<double, 9> intrinsics{};   ///< K, by rows
  std::array<double, 12> projection{};  ///< P, by rows: the camera of rectified images
};

/// A transform from one frame to another: those of tf2_msgs/TFMessage, and poses, which tell where a frame
/// is.
struct TransformMessage {
  MessageHeader header;  ///< the frame that it leads to, the parent
  std::string child;     ///< the frame that it comes from; empty where the message does not name it
  Eigen::Isometry3d child_to_parent = Eigen::Isometry3d::Identity();  ///< not finite where it is unknown
};

// Each throws InputError where the message ends too early or is serialised in a way that is not read.

/// The header of any message that begins with one; the start of its bytes is enough.
MessageHeader read_message_header(const SerialisedMessage& message);
/// The start of the bytes is enough.
ImageStart read_image_start(const SerialisedMessage& message);
ImageMessage read_image(const SerialisedMessage& message);
CompressedImageMessage read_compressed_image(const SerialisedMessage& message);
CameraInfoMessage read_camera_info(const SerialisedMessage& message);
/// tf2_msgs/TFMessage and tf/tfMessage.
std::vector<TransformMessage> read_transforms(const SerialisedMessage& message);
/// geometry_msgs/TransformStamped.
TransformMessage read_stamped_transform(const SerialisedMessage& message);
/// geometry_msgs/PoseStamped and PoseWithCovarianceStamped.
TransformMessage read_pose(const SerialisedMessage& message);
/// nav_msgs/Odometry.
TransformMessage read_odometry(const SerialisedMessage& message);
/// realsense2_camera's Extrinsics, with or without a header: from the first camera that the topic names to
/// the second.
Eigen::Isometry3d read_extrinsics(const SerialisedMessage& message);
/// geometry_msgs/Transform, of a message without a header.
Eigen::Isometry3d read_bare_transform(const SerialisedMessage& message);
/// std_msgs/Float32.
float read_float(const SerialisedMessage& message);

}  // namespace surefield
