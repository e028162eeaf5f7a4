#pragma once

#include <vector>

#include "tools/bench/host_tile_lists.h"

namespace surefield {

/// What blending the tile lists of a view in plain C++ gives. Row-major.
struct CpuImages {
  std::vector<float> red, green, blue;  ///< on black
  std::vector<float> opacity;
  std::vector<float> depth;  ///< D_alpha, metres
};

struct CpuTile;

/// The loop over one tile's Gaussians, compiled for some vector instructions.
struct CpuKernel {
  const char* instructions;  ///< "AVX-512", "AVX2", or "as compiled"
  void (*blend)(CpuTile& tile);
};

/// Those that this processor runs and that are worth measuring, the widest vectors first.
std::vector<CpuKernel> cpu_kernels();

/// The processor's own yardstick for `blend_forward` with Outputs::ColourDepth: the same sums over the same
/// lists, in loops over a tile's pixels that the compiler turns into vector instructions, on all cores.
class CpuBlender {
 public:
  /// The most pixels that a tile may have.
  static constexpr uint32_t kMostPixels = 1024;

  explicit CpuBlender(HostTileLists lists);

  /// Blends the view once; the images stay valid until the next call.
  const CpuImages& blend(const CpuKernel& kernel);

  /// How many threads share the tiles.
  static unsigned threads();

 private:
  HostTileLists lists_;
  CpuImages images_;
};

}  // namespace surefield
