#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "engine/slam/colour_grid.h"
#include "engine/types/camera.h"
#include "engine/types/depth_noise.h"

namespace surefield {

/// The depth of a keyframe in cells, and where it was taken.
struct DepthView {
  const ColourGrid& grid;
  Camera camera;
};

/// Flags of the cells of a keyframe in which something stands that others looked through, as far as they
/// measured beyond it: it came later, or was gone, so it moves. What depth edges and thin things seem to show
/// is left out, and a rim is added around the rest. Empty where nothing moves.
std::vector<uint8_t> moved_cells(const DepthView& keyframe, std::span<const DepthView> others,
                                 const DepthNoise& noise);

/// The same for the pixels of an image of this size, row-major.
std::vector<uint8_t> pixels_of_cells(const std::vector<uint8_t>& cells, const ColourGrid& grid,
                                     cv::Size size);

}  // namespace surefield
