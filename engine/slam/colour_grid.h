#pragma once

#include <Eigen/Core>
#include <vector>

#include "engine/types/frame.h"

namespace surefield {

/// A coarse picture of a frame, made before anything changes its colours: what tells one exposure from
/// another. Cells are squares of pixels, row-major.
struct ColourGrid {
  static constexpr float kFull = 250;  ///< a pixel is saturated in a channel from here on, of 255

  int width = 0;                        ///< in cells
  int height = 0;                       ///< in cells
  int cell = 1;                         ///< side of a cell, pixels
  std::vector<Eigen::Vector3f> colour;  ///< means, 0 to 255
  std::vector<Eigen::Vector3f> peak;    ///< of the brightest pixel, in each channel
  std::vector<float> depth;             ///< of a pixel in the middle, metres; 0 where invalid
};

/// The grid of a frame, about 40 cells wide.
ColourGrid make_colour_grid(const Frame& frame);

}  // namespace surefield
