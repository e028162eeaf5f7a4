#pragma once

#include <vector>

#include "engine/splat/tile_lists.h"

namespace surefield {

/// The tile lists of one view in host memory.
struct HostTileLists {
  TileShape shape;
  ImageSize size;
  uint32_t tiles_x = 0, tiles_y = 0;
  std::vector<glsl::uvec2> ranges;    ///< per tile, row by row: begin and end in `gaussians`
  std::vector<glsl::uint> gaussians;  ///< indices in `splats`, near to far in each tile
  std::vector<glsl::Splat> splats;    ///< per Gaussian of the map
};

/// Reads the lists of the last submitted view back.
HostTileLists download(const TileLists& lists, const ImageSize& size);

/// What blending a view comes to, in (pixel, Gaussian) pairs.
struct PairCount {
  uint64_t processed = 0;  ///< for each tile its pixels times the Gaussians of its list, up to the batch
                           ///< after which no pixel lets light through: what a kernel computes
  uint64_t blended = 0;    ///< of these, those that change a pixel of the image
};

/// Repeats the blending of the transmittance on the host, which takes seconds for large views.
PairCount count_pairs(const HostTileLists& lists);

}  // namespace surefield
