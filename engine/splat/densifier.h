#pragma once

#include "engine/gpu/recorder.h"
#include "engine/splat/engine.h"
#include "engine/splat/gaussian_map.h"
#include "shaders/shared/gather_words.h"
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
  template <class T>
  void gather(gpu::Recorder& recorder, gpu::Array<T>& array, uint32_t words, bool only_kept);
  template <class T>
  void gather_parameter(gpu::Recorder& recorder, Parameter<T>& parameter, uint32_t words);

  gpu::Device& device_;
  gpu::Pass<passes::gather_words> gather_;
  gpu::Pass<passes::split_children> split_;
  gpu::Array<glsl::uint> sources_;
  uint32_t new_size_ = 0;
};

}  // namespace surefield
