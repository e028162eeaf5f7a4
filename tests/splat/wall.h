#pragma once

#include <algorithm>
#include <cmath>

#include "engine/splat/rasteriser.h"
#include "engine/splat/sensor_frame.h"

namespace surefield::testing {

/// A textured wall two metres away, one Gaussian per pixel, as a frame of it would spawn.
inline GaussianCloud wall(int width, int height, double focal) {
  GaussianCloud cloud;
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const double z = 2 + 0.4 * std::sin(0.2 * u) * std::cos(0.15 * v);
      cloud.means.emplace_back(z * (u - width / 2.0) / focal, z * (v - height / 2.0) / focal, z);
      cloud.log_scales.push_back(Eigen::Vector3f::Constant(static_cast<float>(std::log(z / focal))));
      cloud.rotations.emplace_back(1, 0, 0, 0);
      cloud.opacity_logits.push_back(3.0f);
      cloud.uncertainty.push_back(0.0f);
      cloud.anchors.push_back(0);
      cloud.sampling.push_back(static_cast<float>(z / focal));
      for (int c = 0; c < 3; ++c)
        cloud.sh.push_back(static_cast<float>(std::sin(0.5 * u + c) * std::cos(0.4 * v - c)));
    }
  return cloud;
}

/// What was rendered, as a sensor would measure it: no depth where the map is not opaque. `nearer` is taken
/// from the depth, metres.
struct Seen {
  int width, height;
  std::vector<uint8_t> colour;
  std::vector<float> depth;

  explicit Seen(const RenderImages& images, float nearer = 0) : width(images.width), height(images.height) {
    for (float c : images.colour)
      colour.push_back(static_cast<uint8_t>(std::lround(std::clamp(c, 0.0f, 1.0f) * 255)));
    for (std::size_t i = 0; i < images.opacity.size(); ++i)
      depth.push_back(images.opacity[i] < 0.95f ? 0 : images.depth_normalised[i] - nearer);
  }
  FrameView view() const { return {width, height, colour.data(), depth.data()}; }
};

/// The frame that a camera sees of a map.
inline SensorFrame frame_of(gpu::Device& device, Rasteriser& rasteriser, const GaussianMap& map,
                            const Camera& camera) {
  return SensorFrame(device, Seen(rasteriser.render(map, camera)).view());
}

/// Looks at the wall, from the place that it was made for.
inline Camera wall_camera() {
  return {{.width = 96, .height = 72, .fx = 90, .fy = 90, .cx = 47.5, .cy = 35.5}};
}

}  // namespace surefield::testing
