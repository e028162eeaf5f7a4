#pragma once

#include "engine/splat/engine.h"
#include "engine/splat/map_rebuild.h"
#include "shaders/shared/split_children.h"

namespace surefield {

/// What decides the fate of one Gaussian.
struct GaussianStatistics {
  float opacity = 0;
  float largest_scale = 0;    ///< standard deviation, metres
  float screen_gradient = 0;  ///< mean norm since the last densification, in units of half the image
};

/// The new map as sources in the old one, with the SOURCE_ kinds of splat_types.h in the top bits: survivors
/// in their old order first, then clones, then children in pairs.
struct DensifyPlan {
  std::vector<uint32_t> sources;
  DensifyResult result;
};

/// Decides who is split, cloned and removed (3D Gaussian splatting, section 5).
DensifyPlan plan_densification(std::span<const GaussianStatistics> statistics,
                               const DensifySettings& settings);

/// Carries plans out on the device.
class Densifier {
 public:
  explicit Densifier(gpu::Device& device);

  /// Plans and rebuilds the map. Statistics start anew; newborn Gaussians have no moments.
  DensifyResult densify(GaussianMap& map, const DensifySettings& settings);

 private:
  gpu::Device& device_;
  MapRebuild rebuild_;
  gpu::Pass<passes::split_children> split_;
};

}  // namespace surefield
