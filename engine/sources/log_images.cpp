// The images of sensor_msgs/Image and sensor_msgs/CompressedImage.
#include "engine/sources/log_images.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <string_view>

#include "engine/io/encoded_image.h"
#include "engine/io/images.h"
#include "engine/logs/byte_cursor.h"
#include "engine/sources/rvl.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr int kAsItIs = -1;  // no conversion

struct Encoding {
  const char* name;
  LogPixels pixels;
  int type;        ///< OpenCV's, of the stored pixels
  int conversion;  ///< OpenCV's, to RGB
};

// OpenCV names a Bayer pattern by its second row, ROS by its first.
constexpr std::array kEncodings = {
    Encoding{"rgb8", LogPixels::Colour, CV_8UC3, kAsItIs},
    Encoding{"bgr8", LogPixels::Colour, CV_8UC3, cv::COLOR_BGR2RGB},
    Encoding{"8UC3", LogPixels::Colour, CV_8UC3, cv::COLOR_BGR2RGB},
    Encoding{"rgba8", LogPixels::Colour, CV_8UC4, cv::COLOR_RGBA2RGB},
    Encoding{"bgra8", LogPixels::Colour, CV_8UC4, cv::COLOR_BGRA2RGB},
    Encoding{"8UC4", LogPixels::Colour, CV_8UC4, cv::COLOR_BGRA2RGB},
    Encoding{"yuv422", LogPixels::Colour, CV_8UC2, cv::COLOR_YUV2RGB_UYVY},
    Encoding{"uyvy", LogPixels::Colour, CV_8UC2, cv::COLOR_YUV2RGB_UYVY},
    Encoding{"UYVY", LogPixels::Colour, CV_8UC2, cv::COLOR_YUV2RGB_UYVY},
    Encoding{"yuv422_yuy2", LogPixels::Colour, CV_8UC2, cv::COLOR_YUV2RGB_YUY2},
    Encoding{"yuyv", LogPixels::Colour, CV_8UC2, cv::COLOR_YUV2RGB_YUY2},
    Encoding{"YUYV", LogPixels::Colour, CV_8UC2, cv::COLOR_YUV2RGB_YUY2},
    Encoding{"bayer_rggb8", LogPixels::Colour, CV_8UC1, cv::COLOR_BayerBG2RGB},
    Encoding{"bayer_bggr8", LogPixels::Colour, CV_8UC1, cv::COLOR_BayerRG2RGB},
    Encoding{"bayer_gbrg8", LogPixels::Colour, CV_8UC1, cv::COLOR_BayerGR2RGB},
    Encoding{"bayer_grbg8", LogPixels::Colour, CV_8UC1, cv::COLOR_BayerGB2RGB},
    Encoding{"mono8", LogPixels::Grey, CV_8UC1, cv::COLOR_GRAY2RGB},
    Encoding{"8UC1", LogPixels::Grey, CV_8UC1, cv::COLOR_GRAY2RGB},
    Encoding{"16UC1", LogPixels::Depth, CV_16UC1, kAsItIs},
    Encoding{"mono16", LogPixels::Depth, CV_16UC1, kAsItIs},
    Encoding{"32FC1", LogPixels::Depth, CV_32FC1, kAsItIs},
};

const Encoding* find_encoding(const std::string& name) {
  for (const Encoding& encoding : kEncodings)
    if (name == encoding.name) return &encoding;
  return nullptr;
}

/// The stored pixels in memory of their own, in the machine's byte order.
cv::Mat stored_pixels(const ImageMessage& image, int type, const std::filesystem::path& name,
                      cv::Size expected) {
  if (image.width == 0 || image.height == 0 || image.width > uint32_t{kLargestSide} ||
      image.height > uint32_t{kLargestSide})
    throw InputError(name, "is damaged: an image has no size, or too large a one");
  const cv::Size size(static_cast<int>(image.width), static_cast<int>(image.height));
  require_size(name, size, expected);
  const std::size_t row = image.width * CV_ELEM_SIZE(type);
  const std::size_t step = image.step == 0 ? row : image.step;
  if (step < row || image.data.size() < row || (image.data.size() - row) / step < image.height - 1)
    throw InputError(name, "is damaged: an image has too few bytes for its size");
  cv::Mat pixels(size, type);
  for (int y = 0; y < size.height; ++y)
    std::memcpy(pixels.ptr(y), image.data.data() + static_cast<std::size_t>(y) * step, row);
  const std::size_t depth_bytes = CV_ELEM_SIZE1(type);
  if (image.big_endian && depth_bytes > 1) {
    auto* bytes = pixels.data;
    for (std::size_t i = 0; i < pixels.total() * pixels.elemSize(); i += depth_bytes)
      std::reverse(bytes + i, bytes + i + depth_bytes);
  }
  return pixels;
}

[[noreturn]] void refuse_encoding(const std::filesystem::path& name, const std::string& encoding,
                                  const char* wanted) {
  throw InputError(name, fmt::format("its encoding \"{}\" is none of {} that is read", encoding, wanted));
}

/// Metres as they are stored, 0 where nothing was measured.
void clean(cv::Mat& metres) {
  for (int y = 0; y < metres.rows; ++y) {
    auto* row = metres.ptr<float>(y);
    for (int x = 0; x < metres.cols; ++x)
      if (!(row[x] > 0) || !std::isfinite(row[x])) row[x] = 0;
  }
}

bool is_compressed_depth(const CompressedImageMessage& image) {
  return image.format.find("compressedDepth") != std::string::npos;
}

/// What image_transport's compressedDepth stores before the image: a number for the kind, and two floats by
/// which depths in metres became 16-bit numbers, a / depth + b.
struct CompressedDepthHead {
  float a = 0, b = 0;
  std::string_view image;
};

CompressedDepthHead read_depth_head(const CompressedImageMessage& image, const std::filesystem::path& name) {
  ByteCursor cursor(image.data, name);
  CompressedDepthHead head;
  cursor.number<int32_t>();
  head.a = cursor.number<float>();
  head.b = cursor.number<float>();
  head.image = cursor.bytes(cursor.left());
  return head;
}

/// Metres from numbers a / depth + b.
cv::Mat inverted(const cv::Mat& steps, const CompressedDepthHead& head) {
  cv::Mat metres(steps.size(), CV_32FC1);
  for (int y = 0; y < steps.rows; ++y) {
    const auto* in = steps.ptr<uint16_t>(y);
    auto* out = metres.ptr<float>(y);
    for (int x = 0; x < steps.cols; ++x)
      out[x] = in[x] == 0 ? 0.0f : head.a / (static_cast<float>(in[x]) - head.b);
  }
  clean(metres);
  return metres;
}

}  // namespace

LogPixels pixels_of(const std::string& encoding) {
  const Encoding* known = find_encoding(encoding);
  return known ? known->pixels : LogPixels::Unknown;
}

LogPixels pixels_of(const CompressedImageMessage& image) {
  if (is_compressed_depth(image)) return LogPixels::Depth;
  const auto header = read_image_header(image.data);
  if (!header) return is_image(image.data) ? LogPixels::Colour : LogPixels::Unknown;
  if (header->kind == ImageHeader::Kind::Png && header->bits_per_pixel == 16) return LogPixels::Depth;
  return header->bits_per_pixel == 8 ? LogPixels::Grey : LogPixels::Colour;
}

cv::Size size_of_encoded(const CompressedImageMessage& image) {
  constexpr std::size_t kHead = 12;
  std::string_view data = image.data;
  if (is_compressed_depth(image)) data.remove_prefix(std::min(kHead, data.size()));
  if (const auto header = read_image_header(data)) return header->size;
  return is_compressed_depth(image) ? rvl_size(data) : cv::Size();
}

cv::Mat colour_of(const ImageMessage& image, const std::filesystem::path& name, cv::Size expected) {
  const Encoding* encoding = find_encoding(image.encoding);
  if (!encoding || encoding->pixels == LogPixels::Depth) refuse_encoding(name, image.encoding, "colour");
  cv::Mat pixels = stored_pixels(image, encoding->type, name, expected);
  if (encoding->conversion == kAsItIs) return pixels;
  const bool pairs = encoding->type == CV_8UC2 && pixels.cols % 2 != 0;
  const bool bayer = encoding->type == CV_8UC1 && encoding->pixels == LogPixels::Colour;
  if (pairs || (bayer && (pixels.cols < 4 || pixels.rows < 4)))
    throw InputError(name, "is damaged: no image of that encoding has that size");
  cv::Mat colour;
  cv::cvtColor(pixels, colour, encoding->conversion);
  return colour;
}

cv::Mat colour_of(const CompressedImageMessage& image, const std::filesystem::path& name, cv::Size expected) {
  return decode_colour(std::string(image.data), name, expected);
}

cv::Mat depth_of(const ImageMessage& image, double unit, const std::filesystem::path& name,
                 cv::Size expected) {
  const Encoding* encoding = find_encoding(image.encoding);
  if (!encoding || encoding->pixels != LogPixels::Depth) refuse_encoding(name, image.encoding, "depth");
  cv::Mat pixels = stored_pixels(image, encoding->type, name, expected);
  if (pixels.type() == CV_16UC1) return depth_in_metres(pixels, {unit});
  clean(pixels);
  return pixels;
}

cv::Mat depth_of(const CompressedImageMessage& image, double unit, const std::filesystem::path& name,
                 cv::Size expected) {
  if (!is_compressed_depth(image))
    return depth_in_metres(decode_depth_steps(std::string(image.data), name, expected), {unit});
  const CompressedDepthHead head = read_depth_head(image, name);
  const cv::Mat steps = is_png(head.image) ? decode_depth_steps(std::string(head.image), name, expected)
                                           : decode_rvl(head.image, name, expected);
  return image.format.starts_with("32FC1") ? inverted(steps, head) : depth_in_metres(steps, {unit});
}

}  // namespace surefield
