#include "engine/io/images.h"

#include <fmt/format.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string_view>
#include <vector>

#include "engine/io/encoded_image.h"
#include "engine/io/files.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

/// The decoded pixels as OpenCV has them: BGR, or as they are stored.
cv::Mat decode_by_opencv(const std::filesystem::path& file, std::string_view bytes, int flags) {
  cv::Mat image;
  try {
    if (is_image(bytes)) image = cv::imdecode(std::vector<uchar>(bytes.begin(), bytes.end()), flags);
  } catch (const cv::Exception&) {
    image.release();
  }
  if (image.empty()) throw InputError(file, "is not a readable image; it may be damaged or cut off");
  return image;
}

cv::Mat decode(const std::filesystem::path& file, const std::string& bytes, int flags,
               cv::Size expected = {}) {
  const auto header = read_image_header(bytes);
  if (header) {
    require_size(file, header->size, expected);
    require_plausible(*header, bytes.size(), file);
  }
  cv::Mat image = decode_by_opencv(file, is_png(bytes) ? pixels_of_png(bytes, file) : bytes, flags);
  require_size(file, image.size(), expected);
  return image;
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

void require_size(const std::filesystem::path& file, cv::Size size, cv::Size expected) {
  if (expected.empty() || size == expected) return;
  throw InputError(file, fmt::format("is {} x {} pixels, the calibration is for {} x {}", size.width,
                                     size.height, expected.width, expected.height));
}

cv::Mat read_colour(const std::filesystem::path& file, cv::Size expected) {
  return decode_colour(read_regular_file(file), file, expected);
}

cv::Mat decode_colour(const std::string& bytes, const std::filesystem::path& name, cv::Size expected) {
  const auto header = read_image_header(bytes);
  if (header && header->kind == ImageHeader::Kind::Jpeg) {
    require_size(name, header->size, expected);
    require_plausible(*header, bytes.size(), name);
    cv::Mat image = decode_jpeg(bytes, name);
    if (!image.empty()) return image;
  }
  // The calibration is that of the stored pixels, so a rotation noted in the file must not be applied.
  cv::Mat image = decode(name, bytes, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION, expected);
  cv::cvtColor(image, image, cv::COLOR_BGR2RGB);
  return image;
}

cv::Mat decode_depth_steps(const std::string& bytes, const std::filesystem::path& name, cv::Size expected) {
  cv::Mat stored = decode(name, bytes, cv::IMREAD_UNCHANGED, expected);
  if (stored.type() != CV_16UC1) {
    throw InputError(
        name, fmt::format("is no depth image: 16 bits and one channel are needed, it has {} bits "
                          "and {} channel{}",
                          8 * stored.elemSize1(), stored.channels(), stored.channels() == 1 ? "" : "s"));
  }
  return stored;
}

cv::Mat read_depth(const std::filesystem::path& file, const DepthEncoding& encoding, cv::Size expected) {
  return depth_in_metres(decode_depth_steps(read_regular_file(file), file, expected), encoding);
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
  cv::Mat image = decode(file, read_file(file), cv::IMREAD_UNCHANGED);
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
