#pragma once

#include <string>
#include <vector>

#include "engine/sources/depth_range.h"
#include "engine/types/camera.h"

namespace surefield {

/// What cannot be right about a camera by its own numbers: a field of view that no depth camera has, a centre
/// beyond the image or far from its middle, pixels twice as high as wide. One line each, which names the
/// value and what it may come from; empty where nothing speaks against it.
std::vector<std::string> implausible(const Intrinsics& intrinsics);

/// Which depths are used, and which there can be.
struct DepthReach {
  double limit = 0;   ///< metres, farther depths are not used; 0: all are
  double reach = 15;  ///< metres, the sensor does not measure farther (reach_of())
};

/// What cannot be right about depths that were read with `depth_unit`, metres a step: half of them nearer or
/// farther than depth cameras see, hardly a pixel with depth, the largest number that 16 bits hold among
/// them, some beyond the sensor's reach, or nearly all beyond the limit, which is that of `range.beyond`. As
/// above; names the units that would give the depths of a room.
std::vector<std::string> implausible(const DepthRange& range, double depth_unit, const DepthReach& reach);

/// "1/5000", or the number where it is no such fraction of note.
std::string unit_text(double depth_unit);

}  // namespace surefield
