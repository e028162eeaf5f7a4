#include "engine/logs/messages.h"

#include <limits>

#include "engine/io/text_file.h"
#include "engine/logs/message_cursor.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr double kNanosecond = 1e-9;

template <typename Layout>
MessageHeader header_of(MessageCursor<Layout>& cursor) {
  if (Layout::kSequenceNumber) cursor.template number<uint32_t>();
  MessageHeader header;
  const auto seconds = cursor.template number<uint32_t>();
  const auto nanoseconds = cursor.template number<uint32_t>();
  header.stamp = seconds + nanoseconds * kNanosecond;
  header.frame = printable(cursor.text());
  return header;
}

template <typename Layout>
void fill_start(MessageCursor<Layout>& cursor, ImageStart& image) {
  image.header = header_of(cursor);
  image.height = cursor.template number<uint32_t>();
  image.width = cursor.template number<uint32_t>();
  image.encoding = printable(cursor.text());
}

/// Place and quaternion (x, y, z, w); NaN where the quaternion has no direction.
template <typename Layout>
Eigen::Isometry3d rigid_of(MessageCursor<Layout>& cursor) {
  const auto t = cursor.template doubles<3>();
  const auto q = cursor.template doubles<4>();
  const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (rotation.norm() > 1e-6) {
    pose.linear() = rotation.normalized().toRotationMatrix();
    pose.translation() = Eigen::Vector3d(t[0], t[1], t[2]);
  } else {
    pose.matrix().setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return pose;
}

template <typename Layout>
TransformMessage stamped_transform_of(MessageCursor<Layout>& cursor) {
  TransformMessage transform;
  transform.header = header_of(cursor);
  transform.child = printable(cursor.text());
  transform.child_to_parent = rigid_of(cursor);
  return transform;
}

/// Calls `decode` with a cursor for the way in which the message is serialised.
template <typename Decode>
auto decoded(const SerialisedMessage& message, Decode decode) {
  if (message.serialisation == Serialisation::Ros1) {
    MessageCursor<Ros1Layout> cursor(message.bytes, message.name);
    return decode(cursor);
  }
  if (message.serialisation != Serialisation::Cdr)
    throw InputError(message.name, "is serialised in a way that is not read: CDR and ROS 1's are");
  MessageCursor<CdrLayout> cursor(message.bytes, message.name);
  return decode(cursor);
}

}  // namespace

MessageHeader read_message_header(const SerialisedMessage& message) {
  return decoded(message, [](auto& cursor) { return header_of(cursor); });
}

ImageStart read_image_start(const SerialisedMessage& message) {
  return decoded(message, [](auto& cursor) {
    ImageStart image;
    fill_start(cursor, image);
    return image;
  });
}

ImageMessage read_image(const SerialisedMessage& message) {
  return decoded(message, [](auto& cursor) {
    ImageMessage image;
    fill_start(cursor, image);
    image.big_endian = cursor.template number<uint8_t>() != 0;
    image.step = cursor.template number<uint32_t>();
    image.data = cursor.data();
    return image;
  });
}

CompressedImageMessage read_compressed_image(const SerialisedMessage& message) {
  return decoded(message, [](auto& cursor) {
    CompressedImageMessage image;
    image.header = header_of(cursor);
    image.format = printable(cursor.text());
    image.data = cursor.data();
    return image;
  });
}

CameraInfoMessage read_camera_info(const SerialisedMessage& message) {
  return decoded(message, [](auto& cursor) {
    CameraInfoMessage info;
    info.header = header_of(cursor);
    info.height = cursor.template number<uint32_t>();
    info.width = cursor.template number<uint32_t>();
    info.model = printable(cursor.text());
    info.distortion = cursor.double_list();
    info.intrinsics = cursor.template doubles<9>();
    cursor.template doubles<9>();  // R
    info.projection = cursor.template doubles<12>();
    return info;
  });
}

std::vector<TransformMessage> read_transforms(const SerialisedMessage& message) {
  return decoded(message, [](auto& cursor) {
    std::vector<TransformMessage> transforms;
    // Not reserved: a damaged message may promise any number.
    for (auto left = cursor.template number<uint32_t>(); left > 0; --left)
      transforms.push_back(stamped_transform_of(cursor));
    return transforms;
  });
}

TransformMessage read_stamped_transform(const SerialisedMessage& message) {
  return decoded(message, [](auto& cursor) { return stamped_transform_of(cursor); });
}

TransformMessage read_pose(const SerialisedMessage& message) {
  return decoded(message, [](auto& cursor) {
    TransformMessage pose;
    pose.header = header_of(cursor);
    pose.child_to_parent = rigid_of(cursor);
    return pose;
  });
}

TransformMessage read_odometry(const SerialisedMessage& message) {
  return decoded(message, [](auto& cursor) { return stamped_transform_of(cursor); });
}

Eigen::Isometry3d read_extrinsics(const SerialisedMessage& message) {
  constexpr std::size_t kNumbers = (9 + 3) * sizeof(double);
  return decoded(message, [](auto& cursor) {
    if (cursor.left() >= kNumbers + 3 * sizeof(uint32_t)) header_of(cursor);
    const auto rotation = cursor.template doubles<9>();
    const auto translation = cursor.template doubles<3>();
    Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
    transform.linear() = Eigen::Map<const Eigen::Matrix3d>(rotation.data());  // column by column, both
    transform.translation() = Eigen::Map<const Eigen::Vector3d>(translation.data());
    return transform;
  });
}

Eigen::Isometry3d read_bare_transform(const SerialisedMessage& message) {
  return decoded(message, [](auto& cursor) { return rigid_of(cursor); });
}

float read_float(const SerialisedMessage& message) {
  return decoded(message, [](auto& cursor) { return cursor.template number<float>(); });
}

}  // namespace surefield
