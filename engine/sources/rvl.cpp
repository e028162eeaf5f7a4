#include "engine/sources/rvl.h"

#include <cstring>

#include "engine/io/images.h"
#include "engine/logs/byte_cursor.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr std::size_t kSizeBytes = 2 * sizeof(int32_t);
constexpr int kGroups = 8;       // in a word, the first in its highest bits
constexpr int kMostGroups = 11;  // that a number of 32 bits takes

class RvlReader {
 public:
  RvlReader(std::string_view words, const std::filesystem::path& name) : cursor_(words, name), name_(name) {}

  uint32_t number() {
    uint32_t value = 0;
    for (int i = 0; i < kMostGroups; ++i) {
      const uint32_t group = next_group();
      value |= (group & 7u) << (3 * i);
      if ((group & 8u) == 0) return value;
    }
    throw InputError(name_, "is damaged: a number of its depth image does not end");
  }

 private:
  uint32_t next_group() {
    if (left_ == 0) {
      word_ = cursor_.number<uint32_t>();
      left_ = kGroups;
    }
    const uint32_t group = word_ >> 28;
    word_ <<= 4;
    --left_;
    return group;
  }

  ByteCursor cursor_;
  const std::filesystem::path& name_;
  uint32_t word_ = 0;
  int left_ = 0;  ///< groups of the word
};

/// 0, -1, 1, -2, 2, ...
int32_t signed_of(uint32_t zigzag) {
  return static_cast<int32_t>(zigzag >> 1) ^ -static_cast<int32_t>(zigzag & 1);
}

}  // namespace

cv::Size rvl_size(std::string_view packed) {
  if (packed.size() < kSizeBytes) return {};
  int32_t sides[2];
  std::memcpy(sides, packed.data(), sizeof(sides));
  const bool plausible = sides[0] > 0 && sides[1] > 0 && sides[0] <= kLargestSide && sides[1] <= kLargestSide;
  return plausible ? cv::Size(sides[0], sides[1]) : cv::Size();
}

cv::Mat decode_rvl(std::string_view packed, const std::filesystem::path& name, cv::Size expected) {
  const cv::Size size = rvl_size(packed);
  if (size.empty()) throw InputError(name, "is damaged: its depth image has no size");
  require_size(name, size, expected);
  // A few bytes may stand for any number of zeros, but a size that the calibration does not confirm takes no
  // more memory than images have.
  constexpr std::size_t kMostPixels = std::size_t{1} << 27;
  const auto pixels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
  if (pixels > kMostPixels) throw InputError(name, "is damaged: its depth image is too large");
  cv::Mat depth(size, CV_16UC1, cv::Scalar(0));
  auto* out = reinterpret_cast<uint16_t*>(depth.data);
  RvlReader reader(packed.substr(kSizeBytes), name);
  std::size_t at = 0;
  uint32_t last = 0;
  while (at < pixels) {
    const std::size_t zeros = reader.number();
    const std::size_t others = zeros > pixels - at ? pixels : reader.number();
    if (zeros > pixels - at || others > pixels - at - zeros)
      throw InputError(name, "is damaged: its depth image has too many pixels");
    at += zeros;
    for (std::size_t i = 0; i < others; ++i) {
      last += static_cast<uint32_t>(signed_of(reader.number()));
      out[at++] = static_cast<uint16_t>(last);
    }
    if (zeros == 0 && others == 0) throw InputError(name, "is damaged: its depth image does not end");
  }
  return depth;
}

}  // namespace surefield
