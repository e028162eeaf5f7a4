#pragma once

#include <cstdint>

namespace surefield {

/// A random number that depends on its key alone, so that the order of drawing does not matter and the same
/// numbers come on every machine.
inline uint32_t hash_key(uint32_t seed, uint32_t a, uint32_t b = 0, uint32_t c = 0) {
  const auto mix = [](uint32_t h) {
    h = (h ^ (h >> 16)) * 0x7feb352du;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    return h ^ (h >> 16);
  };
  return mix(mix(mix(mix(seed * 0x9e3779b9u + 1) ^ a) + b) ^ c);
}

/// Uniform in [0, 1).
inline double unit_interval(uint32_t hash) {
  return static_cast<double>(hash) * 0x1p-32;
}

/// Numbers one after the other, for building scenes.
class RandomStream {
 public:
  explicit RandomStream(uint32_t seed) : seed_(seed) {}

  uint32_t bits() { return hash_key(seed_, counter_++); }
  /// Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * unit_interval(bits()); }
  /// 0 to count - 1.
  int index(int count) { return static_cast<int>(unit_interval(bits()) * count); }

 private:
  uint32_t seed_;
  uint32_t counter_ = 0;
};

}  // namespace surefield
