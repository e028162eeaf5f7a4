#pragma once

#include "engine/splat/tile_lists.h"

namespace surefield {

/// How many (pixel, Gaussian) pairs blending computes for the last submitted view: for each tile its pixels
/// times the Gaussians of its list up to the batch after which no pixel lets light through. Repeats the
/// blending of the transmittance on the host, which takes seconds for large views.
uint64_t count_pairs(const TileLists& lists, const ImageSize& size);

}  // namespace surefield
