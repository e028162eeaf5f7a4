#pragma once

#include <span>
#include <vector>

#include "engine/types/depth_noise.h"
#include "tests/reference/types.h"

namespace surefield::reference {

/// What the pixels that one Gaussian dominates add up to (paper eq. 13).
struct DominatedPixels {
  double sum = 0;  ///< of alpha T (D - z)^2, m^2
  int count = 0;   ///< of those with valid sensor depth

  double mean() const { return sum / count; }
};

/// Adds the pixels of one view: `images` as render() gives them for `gaussians` and `camera`. `dominated` has
/// one entry per Gaussian. Where 4 of the sensor's deviations, `noise`, are more than the error that is
/// judged uncertain, the root of `above`, errors count as much less.
void add_dominated_pixels(const Gaussians& gaussians, const Camera& camera, const Images& images,
                          std::span<const float> sensor_depth, const DepthNoise& noise, double above,
                          std::vector<DominatedPixels>& dominated);

}  // namespace surefield::reference
