#include "tests/reference/uncertainty.h"

#include <algorithm>
#include <cmath>

namespace surefield::reference {

void add_dominated_pixels(const Gaussians& gaussians, const Camera& camera, const Images& images,
                          std::span<const float> sensor_depth, const DepthNoise& noise, double above,
                          std::vector<DominatedPixels>& dominated) {
  for (std::size_t p = 0; p < sensor_depth.size(); ++p) {
    const int32_t gaussian = images.dominator[p];
    if (gaussian < 0 || !valid_depth(sensor_depth[p])) continue;
    const double allowed = 4 * noise.sigma(sensor_depth[p]),
                 share = std::min(1.0, std::sqrt(above) / allowed);
    const double off = share * (sensor_depth[p] - (camera.world_to_camera * gaussians.means[gaussian]).z());
    dominated[gaussian].sum += images.dominator_weight[p] * off * off;
    ++dominated[gaussian].count;
  }
}

}  // namespace surefield::reference
