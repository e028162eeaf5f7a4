#include "tests/reference/uncertainty.h"

namespace surefield::reference {

void add_dominated_pixels(const Gaussians& gaussians, const Camera& camera, const Images& images,
                          std::span<const float> sensor_depth, std::vector<DominatedPixels>& dominated) {
  for (std::size_t p = 0; p < sensor_depth.size(); ++p) {
    const int32_t gaussian = images.dominator[p];
    if (gaussian < 0 || !valid_depth(sensor_depth[p])) continue;
    const double off = sensor_depth[p] - (camera.world_to_camera * gaussians.means[gaussian]).z();
    dominated[gaussian].sum += images.dominator_weight[p] * off * off;
    ++dominated[gaussian].count;
  }
}

}  // namespace surefield::reference
