#pragma once

#include <random>
#include <string>
#include <vector>

#include "engine/primitives/device_count.h"

namespace surefield::testing {

/// A count on the device with the array that holds it.
class HeldCount {
 public:
  HeldCount(gpu::Device& device, uint32_t count, uint32_t capacity)
      : value_(device, "count"), capacity_(capacity) {
    value_.upload(std::vector<uint32_t>{count});
  }
  operator DeviceCount() const { return {value_, capacity_}; }

 private:
  gpu::Array<glsl::uint> value_;
  uint32_t capacity_;
};

/// A device array with the given contents.
template <class T>
gpu::Array<T> upload(gpu::Device& device, const std::string& name, const std::vector<T>& data) {
  gpu::Array<T> array(device, name, data.size());
  array.upload(data);
  return array;
}

/// A random number below `limit`.
inline uint32_t random_below(std::mt19937& random, uint32_t limit) {
  return std::uniform_int_distribution<uint32_t>(0, limit - 1)(random);
}

/// A random size up to 2^`bits`, of every order of magnitude alike.
inline uint32_t random_size(std::mt19937& random, uint32_t bits) {
  return 1 + random_below(random, 1u << (1 + random_below(random, bits)));
}

/// `count` random words below 2^bits.
inline std::vector<uint32_t> random_words(uint32_t seed, std::size_t count, uint32_t bits = 32) {
  std::mt19937 random(seed);
  std::vector<uint32_t> words(count);
  for (uint32_t& word : words) word = static_cast<uint32_t>(random() & ((uint64_t{1} << bits) - 1));
  return words;
}

}  // namespace surefield::testing
