#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>

#include "engine/logs/messages.h"

namespace surefield {

/// What the pixels of an image message can be, by its encoding.
enum class LogPixels { Colour, Grey, Depth, Unknown };

/// By the encoding of sensor_msgs/Image. 16 bits of one channel are depth, though infrared images may have
/// them too.
LogPixels pixels_of(const std::string& encoding);

/// By the format and the data of sensor_msgs/CompressedImage.
LogPixels pixels_of(const CompressedImageMessage& image);

/// The size of an encoded image by its header; empty where that cannot be read.
cv::Size size_of_encoded(const CompressedImageMessage& image);

// All below: errors call the image `name`, and `expected`, where it is not empty, is the size that it must
// have. Throws InputError where it has another, is damaged, or encoded in a way that is not read.

/// CV_8UC3, RGB; grey images in three equal channels.
cv::Mat colour_of(const ImageMessage& image, const std::filesystem::path& name, cv::Size expected = {});
cv::Mat colour_of(const CompressedImageMessage& image, const std::filesystem::path& name,
                  cv::Size expected = {});

/// CV_32FC1, metres, 0 where nothing was measured. `unit`: metres for one step of 16-bit images.
cv::Mat depth_of(const ImageMessage& image, double unit, const std::filesystem::path& name,
                 cv::Size expected = {});
cv::Mat depth_of(const CompressedImageMessage& image, double unit, const std::filesystem::path& name,
                 cv::Size expected = {});

}  // namespace surefield
