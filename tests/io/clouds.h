#pragma once

#include <cmath>
#include <random>

#include "engine/splat/gaussian_cloud.h"

namespace surefield::test {

/// Gaussians whose values every format can hold.
inline GaussianCloud random_cloud(std::size_t count, int sh_degree) {
  std::mt19937 random(static_cast<unsigned>(7 + sh_degree));
  std::uniform_real_distribution<float> value(-1, 1);
  GaussianCloud cloud;
  cloud.sh_degree = sh_degree;
  cloud.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (float& x : cloud.means[i]) x = 10 * value(random);
    for (float& x : cloud.log_scales[i]) x = 7 * value(random) - 2;
    for (float& x : cloud.rotations[i]) x = 3 * value(random);
    cloud.opacity_logits[i] = 6 * value(random);
    cloud.uncertainty[i] = std::abs(value(random));
  }
  for (float& x : cloud.sh) x = 0.99f * value(random);
  return cloud;
}

}  // namespace surefield::test
