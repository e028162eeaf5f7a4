#include "engine/splat/packed_images.h"

#include <bit>

namespace surefield {

namespace {

constexpr std::size_t kMostValues = 1u << 16;  // that two bytes tell apart
constexpr std::size_t kTableSize = 1u << 17;   // a power of two, twice as many as are ever in it

/// Numbers values in the order of their coming, by a hash table with linear probing.
class ValueNumbers {
 public:
  std::vector<float> values;

  /// The number of `value`; kMostValues when there is none left for it.
  std::size_t of(float value) {
    const auto bits = std::bit_cast<uint32_t>(value);
    for (std::size_t slot = (bits * 2654435761u) >> 15;; slot = (slot + 1) % kTableSize) {
      uint32_t& entry = table_[slot];
      if (entry == 0) {
        if (values.size() == kMostValues) return kMostValues;
        values.push_back(value);
        entry = static_cast<uint32_t>(values.size());
      }
      if (std::bit_cast<uint32_t>(values[entry - 1]) == bits) return entry - 1;
    }
  }

 private:
  std::vector<uint32_t> table_ = std::vector<uint32_t>(kTableSize);  ///< number + 1; 0: free
};

}  // namespace

PackedImages::PackedImages(std::span<const uint32_t> colour, std::span<const float> depth) {
  rgb_.reserve(3 * colour.size());
  for (uint32_t pixel : colour)
    for (int shift : {0, 8, 16}) rgb_.push_back(static_cast<uint8_t>(pixel >> shift));
  ValueNumbers numbers;
  places_.reserve(depth.size());
  for (float z : depth) {
    const std::size_t number = numbers.of(z);
    if (number == kMostValues) {
      places_ = {};
      depths_.assign(depth.begin(), depth.end());
      return;
    }
    places_.push_back(static_cast<uint16_t>(number));
  }
  depths_ = std::move(numbers.values);
}

std::vector<uint32_t> PackedImages::colour() const {
  std::vector<uint32_t> pixels(rgb_.size() / 3);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    pixels[i] = rgb_[3 * i] | uint32_t{rgb_[3 * i + 1]} << 8 | uint32_t{rgb_[3 * i + 2]} << 16 | 0xFF000000u;
  return pixels;
}

std::vector<float> PackedImages::depth() const {
  if (places_.empty()) return depths_;
  std::vector<float> metres(places_.size());
  for (std::size_t i = 0; i < metres.size(); ++i) metres[i] = depths_[places_[i]];
  return metres;
}

uint64_t PackedImages::bytes() const {
  return rgb_.size() + places_.size() * sizeof(uint16_t) + depths_.size() * sizeof(float);
}

}  // namespace surefield
