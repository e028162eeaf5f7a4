#pragma once

#include <random>
#include <string>
#include <vector>

#include "engine/sources/open_dataset.h"
#include "engine/types/camera.h"
#include "tests/support/input_files.h"
#include "tests/support/log_writers.h"

namespace surefield::test {

/// A message of a log, serialised by `write(writer)`.
template <typename Write>
WrittenMessage message(const std::string& topic, const std::string& type, int64_t stamp, Wire wire,
                       Write write) {
  MessageWriter writer(wire);
  write(writer);
  return {topic, type, stamp, writer.bytes()};
}

/// Where an image is logged.
struct ImagePlace {
  std::string topic;
  std::string frame;
  int64_t stamp = 0;  ///< nanoseconds, of its header
};

/// sensor_msgs/Image.
inline WrittenMessage image_message(const ImagePlace& place, const cv::Mat& image,
                                    const std::string& encoding, Wire wire) {
  return message(place.topic, "sensor_msgs/Image", place.stamp, wire, [&](MessageWriter& writer) {
    const auto step = static_cast<uint32_t>(static_cast<std::size_t>(image.cols) * image.elemSize());
    writer.header(place.stamp, place.frame).number(static_cast<uint32_t>(image.rows));
    writer.number(static_cast<uint32_t>(image.cols)).text(encoding).number(uint8_t{0}).number(step);
    writer.data({reinterpret_cast<const char*>(image.data), step * static_cast<std::size_t>(image.rows)});
  });
}

/// sensor_msgs/CompressedImage.
inline WrittenMessage compressed_message(const ImagePlace& place, const std::string& bytes,
                                         const std::string& format, Wire wire) {
  return message(place.topic, "sensor_msgs/CompressedImage", place.stamp, wire, [&](MessageWriter& writer) {
    writer.header(place.stamp, place.frame).text(format).data(bytes);
  });
}

/// sensor_msgs/CameraInfo, whose P is K.
inline WrittenMessage camera_message(const ImagePlace& place, const Intrinsics& k,
                                     const std::vector<double>& distortion, Wire wire,
                                     const std::string& model = "plumb_bob") {
  return message(place.topic, "sensor_msgs/CameraInfo", place.stamp, wire, [&](MessageWriter& writer) {
    writer.header(place.stamp, place.frame).number(static_cast<uint32_t>(k.height));
    writer.number(static_cast<uint32_t>(k.width)).text(model);
    writer.number(static_cast<uint32_t>(distortion.size())).doubles(distortion);
    writer.doubles({k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1}).doubles({1, 0, 0, 0, 1, 0, 0, 0, 1});
    writer.doubles({k.fx, 0, k.cx, 0, 0, k.fy, k.cy, 0, 0, 0, 1, 0});
  });
}

/// A transform as tf has it: child and where it is in its parent, without rotation.
struct WrittenTransform {
  std::string parent, child;
  std::vector<double> place;
};

/// tf2_msgs/TFMessage.
inline WrittenMessage transform_message(const std::string& topic, int64_t stamp,
                                        const std::vector<WrittenTransform>& transforms, Wire wire) {
  return message(topic, "tf2_msgs/TFMessage", stamp, wire, [&](MessageWriter& writer) {
    writer.number(static_cast<uint32_t>(transforms.size()));
    for (const WrittenTransform& transform : transforms)
      writer.header(stamp, transform.parent)
          .text(transform.child)
          .doubles(transform.place)
          .doubles({0, 0, 0, 1});
  });
}

inline constexpr Intrinsics kLogCamera = {32, 24, 30, 31, 15.5, 11.5};
inline constexpr int64_t kLogStart = 1305031102175304000;
inline constexpr int64_t kFrameTime = 33333000;

/// Random colour and depth of frame `i`, 16-bit steps; some pixels have no depth.
inline cv::Mat random_colour(int i) {
  std::mt19937 random(static_cast<unsigned>(i));
  cv::Mat image(24, 32, CV_8UC3);
  for (std::size_t n = 0; n < image.total() * 3; ++n) image.data[n] = static_cast<uint8_t>(random());
  return image;
}
inline cv::Mat random_depth(int i) {
  std::mt19937 random(static_cast<unsigned>(100 + i));
  cv::Mat image(24, 32, CV_16UC1);
  for (auto it = image.begin<uint16_t>(); it != image.end<uint16_t>(); ++it)
    *it = static_cast<uint16_t>(random() % 5 == 0 ? 0 : 500 + random() % 4000);
  return image;
}

/// Whether two recordings give the same frames, bit for bit.
inline void check_same_frames(const Recording& a, const Recording& b) {
  REQUIRE(a.count() == b.count());
  CHECK(a.intrinsics().width == b.intrinsics().width);
  CHECK(a.intrinsics().fx == b.intrinsics().fx);
  CHECK(a.intrinsics().cy == b.intrinsics().cy);
  for (int i = 0; i < a.count(); ++i) {
    const LoadedFrame one = a.load(i), other = b.load(i);
    REQUIRE_MESSAGE(one.frame, one.problem);
    REQUIRE_MESSAGE(other.frame, other.problem);
    CHECK(one.frame->timestamp == other.frame->timestamp);
    CHECK(one.frame->depth_after == other.frame->depth_after);
    CHECK(cv::norm(one.frame->colour, other.frame->colour, cv::NORM_INF) == 0);
    CHECK(cv::norm(one.frame->depth, other.frame->depth, cv::NORM_INF) == 0);
  }
}

inline std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

}  // namespace surefield::test
