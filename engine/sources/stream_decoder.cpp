#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>

#include "engine/io/encoded_image.h"
#include "engine/io/images.h"
#include "engine/sources/recording.h"
#include "engine/sources/stream_reader.h"

namespace surefield {

namespace {

/// Raw pixels as an image with memory of its own; there are as many bytes as it needs.
cv::Mat image_of(const std::string& bytes, cv::Size size, int type) {
  cv::Mat image(size, type);
  std::memcpy(image.data, bytes.data(), bytes.size());
  return image;
}

}  // namespace

cv::Mat StreamDecoder::colour_of(const StreamFrame& stored, const std::string& name) const {
  const cv::Size size(header_.camera.intrinsics.width, header_.camera.intrinsics.height);
  if (stored.colour_kind == StreamColour::Jpeg || stored.colour_kind == StreamColour::Png)
    return decode_colour(stored.colour, name + ", its colour", size);
  cv::Mat image = image_of(stored.colour, size, CV_8UC3);
  if (stored.colour_kind == StreamColour::Bgr8) cv::cvtColor(image, image, cv::COLOR_BGR2RGB);
  return image;
}

cv::Mat StreamDecoder::depth_of(const StreamFrame& stored, const std::string& name) const {
  const cv::Size size(header_.camera.intrinsics.width, header_.camera.intrinsics.height);
  const DepthEncoding encoding{header_.camera.depth_unit};
  if (stored.depth_kind == StreamDepth::Png16)
    return depth_in_metres(decode_depth_steps(stored.depth, name + ", its depth", size), encoding);
  if (stored.depth_kind == StreamDepth::Steps16)
    return depth_in_metres(image_of(stored.depth, size, CV_16UC1), encoding);
  cv::Mat metres = image_of(stored.depth, size, CV_32FC1);
  metres.forEach<float>([](float& z, const int*) {
    if (!(z > 0) || !std::isfinite(z)) z = 0;
  });
  return metres;
}

Frame StreamDecoder::decode(const StreamFrame& stored) const {
  const std::string name = fmt::format("message {}", stored.message);
  Frame frame{stored.index, stored.stamp, undistortion_.colour(colour_of(stored, name)),
              undistortion_.depth(depth_of(stored, name))};
  frame.depth_after = depth_after(stored.stamp, stored.depth_stamp);
  return frame;
}

}  // namespace surefield
