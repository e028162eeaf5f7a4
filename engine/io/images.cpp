#include "engine/io/images.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string_view>
#include <vector>

#include "engine/io/files.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

/// A JPEG without its end marker was cut off; libjpeg would fill the rest with grey and call it a success.
bool is_truncated_jpeg(std::string_view bytes) {
  if (!bytes.starts_with("\xff\xd8")) return false;
  const auto end = bytes.find_last_not_of('\0');
  return end == std::string_view::npos || end < 3 || bytes.substr(end - 1, 2) != "\xff\xd9";
}

cv::Mat decode(const std::filesystem::path& file, const std::string& bytes, int flags) {
  cv::Mat image;
  if (!bytes.empty() && !is_truncated_jpeg(bytes)) {
    try {
      image = cv::imdecode(std::vector<uchar>(bytes.begin(), bytes.end()), flags);
    } catch (const cv::Exception&) {
      image.release();
    }
  }
  if (image.empty()) throw InputError(file, "is not a readable image; it may be damaged or cut off");
  return image;
}

cv::Mat decode(const std::filesystem::path& file, int flags) {
  return decode(file, read_file(file), flags);
}

void encode(const std::filesystem::path& file, const char* extension, const cv::Mat& image,
            const std::vector<int>& parameters) {
  cv::Mat stored;  // a buffer of its own: the caller's pixels stay as they are
  if (image.channels() == 3) {
    cv::cvtColor(image, stored, cv::COLOR_RGB2BGR);
  } else {
    stored = image;
  }
  std::vector<uchar> bytes;
  if (!cv::imencode(extension, stored, bytes, parameters))
    throw InputError(file, "the image cannot be encoded");
  write_file(file, [&](std::ostream& stream) {
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  });
}

cv::Mat to_8bit(const cv::Mat& image) {
  cv::Mat clean = image.clone();
  cv::patchNaNs(clean, 0);
  clean = cv::min(cv::max(clean, 0.0), 1.0);  // convertTo alone would turn infinity into 0
  clean.convertTo(clean, CV_8U, 255.0);
  return clean;
}

}  // namespace

cv::Mat read_colour(const std::filesystem::path& file) {
  return decode_colour(read_file(file), file);
}

cv::Mat decode_colour(const std::string& bytes, const std::filesystem::path& name) {
  // The calibration is that of the stored pixels, so a rotation noted in the file must not be applied.
  cv::Mat image = decode(name, bytes, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  cv::cvtColor(image, image, cv::COLOR_BGR2RGB);
  return image;
}

cv::Mat read_depth(const std::filesystem::path& file, const DepthEncoding& encoding) {
  const cv::Mat stored = decode(file, cv::IMREAD_UNCHANGED);
  if (stored.type() != CV_16UC1)
    throw InputError(file, "is no depth image; 16 bits and one channel are needed");
  return depth_in_metres(stored, encoding);
}

cv::Mat depth_in_metres(const cv::Mat& stored, const DepthEncoding& encoding) {
  cv::Mat depth(stored.size(), CV_32FC1);
  for (int y = 0; y < stored.rows; ++y) {
    const auto* in = stored.ptr<uint16_t>(y);
    auto* out = depth.ptr<float>(y);
    for (int x = 0; x < stored.cols; ++x) {
      out[x] = in[x] == encoding.invalid_value ? 0.0f : static_cast<float>(in[x] * encoding.unit);
    }
  }
  return depth;
}

void write_tiff(const std::filesystem::path& file, const cv::Mat& image) {
  if (image.empty() || (image.type() != CV_32FC1 && image.type() != CV_32FC3)) {
    throw InputError(file, "only 32-bit float images of 1 or 3 channels can be written as TIFF here");
  }
  constexpr int kUncompressed = 1;  // COMPRESSION_NONE of libtiff
  encode(file, ".tiff", image, {cv::IMWRITE_TIFF_COMPRESSION, kUncompressed});
}

cv::Mat read_tiff(const std::filesystem::path& file) {
  cv::Mat image = decode(file, cv::IMREAD_UNCHANGED);
  if (image.type() != CV_32FC1 && image.type() != CV_32FC3) {
    throw InputError(file, "is no 32-bit float image of 1 or 3 channels");
  }
  if (image.channels() == 3) cv::cvtColor(image, image, cv::COLOR_BGR2RGB);
  return image;
}

void write_png(const std::filesystem::path& file, const cv::Mat& image) {
  const bool is_float = image.type() == CV_32FC1 || image.type() == CV_32FC3;
  const bool is_integer = image.type() == CV_8UC1 || image.type() == CV_8UC3 || image.type() == CV_16UC1;
  if (image.empty() || (!is_float && !is_integer)) {
    throw InputError(file, "an image of this type cannot be written as PNG");
  }
  encode(file, ".png", is_float ? to_8bit(image) : image, {});
}

void write_jpeg(const std::filesystem::path& file, const cv::Mat& image, int quality) {
  if (image.empty() || image.type() != CV_8UC3) {
    throw InputError(file, "an image of this type cannot be written as JPEG");
  }
  encode(file, ".jpg", image, {cv::IMWRITE_JPEG_QUALITY, quality});
}

}  // namespace surefield
