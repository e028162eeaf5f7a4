#pragma once

#include <cstddef>
#include <cstdint>

namespace surefield::spz {

constexpr uint32_t kMagic = 0x5053474e;  ///< "NGSP", little endian
constexpr std::size_t kHeaderBytes = 16;
constexpr int kBytesPerCoordinate = 3;

/// Colours are stored as 255 (kColourScale f_dc + 0.5).
constexpr float kColourScale = 0.15f;
/// Scales are stored as 16 (ln(scale) + 10).
constexpr float kScaleSteps = 16;
constexpr float kScaleOffset = 10;

/// What the file starts with, after decompression.
struct Header {
  uint32_t magic = kMagic;
  uint32_t version = 2;
  uint32_t count = 0;
  uint8_t sh_degree = 0;
  uint8_t fractional_bits = 0;
  uint8_t flags = 0;
  uint8_t reserved = 0;
};
static_assert(sizeof(Header) == kHeaderBytes);

}  // namespace surefield::spz
