#pragma once

#include <cstdint>
#include <vector>

#include "engine/types/frame.h"

namespace surefield {

/// A square of pixels that one newborn Gaussian stands for.
struct BirthCell {
  int u = 0, v = 0;  ///< its upper left pixel
  int size = 1;      ///< pixels along a side
};

/// Divides the pixels that are `wanted` (one flag a pixel, row by row; their depth is valid) into squares:
/// of `largest` pixels along a side where the colour is even and the depth flat, else of half of that, and so
/// on down to single pixels. Larger ones come first, each size row by row.
std::vector<BirthCell> birth_cells(const Frame& frame, std::vector<uint8_t> wanted, int largest);

}  // namespace surefield
