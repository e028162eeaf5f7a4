#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "engine/formats/ply.h"
#include "engine/formats/ply_header.h"

namespace surefield {

/// Reads the compressed cloud whose header is `header` (docs/formats.md). Throws InputError where it is none,
/// and for truncated files.
PlyCloud read_compressed_ply(const std::filesystem::path& file, const PlyHeader& header);

namespace compressed_ply {

/// So many Gaussians in a row share the bounds of their values.
constexpr std::size_t kChunk = 256;

/// The bounds of a chunk: positions in metres, ln(scale), and colours 0 to 1 (not limited to that).
constexpr std::array<const char*, 18> kBounds = {
    "min_x",       "min_y",       "min_z",       "max_x",       "max_y",       "max_z",
    "min_scale_x", "min_scale_y", "min_scale_z", "max_scale_x", "max_scale_y", "max_scale_z",
    "min_r",       "min_g",       "min_b",       "max_r",       "max_g",       "max_b"};

/// What has bounds.
enum Attribute : std::size_t { kPosition, kScale, kColour };

/// Where in kBounds an attribute's lower bound stands.
constexpr std::size_t low(std::size_t attribute, std::size_t axis) {
  return 6 * attribute + axis;
}
/// Where the upper one.
constexpr std::size_t high(std::size_t attribute, std::size_t axis) {
  return low(attribute, axis) + 3;
}

/// The numbers of a Gaussian, 32 bits each.
constexpr std::array<const char*, 4> kPacked = {"packed_position", "packed_rotation", "packed_scale",
                                                "packed_color"};

/// The widths in bits of three values that are packed into one number, from its highest bits down.
constexpr std::array<int, 3> kVectorBits = {11, 10, 11};
/// Those of a colour and its opacity: four bytes.
constexpr int kColourBits = 8;
/// Those of three of a quaternion's numbers w, x, y, z; above them is the index of the largest, left out one.
constexpr int kRotationBits = 10;

/// SH coefficients are stored in 256 steps from -kShRange to kShRange.
constexpr float kShRange = 4;

/// The largest value of so many bits.
constexpr uint32_t most(int bits) {
  return (1u << bits) - 1;
}

}  // namespace compressed_ply

}  // namespace surefield
