#pragma once

#include "engine/gpu/recorder.h"
#include "engine/splat/gaussian_map.h"
#include "shaders/shared/gather_words.h"

namespace surefield {

/// Puts the Gaussians of a map in a new order, leaves some out, or has several stem from one.
class MapRebuild {
 public:
  explicit MapRebuild(gpu::Device& device);

  /// Makes Gaussian i of the map what Gaussian `new_sources[i]` was, with a SOURCE_ kind of splat_types.h in
  /// the top bits; what is not SOURCE_KEPT starts without moments and statistics.
  void rebuild(GaussianMap& map, std::span<const uint32_t> new_sources);

  gpu::Array<glsl::uint> sources;  ///< of the last call

 private:
  gpu::Device& device_;
  gpu::Pass<passes::gather_words> gather_;
  gpu::Array<glsl::uint> rebuilt_;  ///< an array of the map in its new order
};

}  // namespace surefield
