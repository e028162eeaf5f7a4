#pragma once

#include <optional>

#include "engine/mesh/tsdf_volume.h"

namespace surefield {

/// What a camera saw at a place between pixels.
struct DepthSample {
  float depth = 0;  ///< metres along camera z
  Eigen::Vector3f colour = Eigen::Vector3f::Zero();
};

/// Looks depth and colour of a view up between pixels.
class DepthSampler {
 public:
  /// Depths of neighbouring pixels that differ by more than `edge` metres belong to different surfaces.
  /// `view` must outlive the sampler.
  DepthSampler(const DepthView& view, double edge);

  /// Interpolates between the four pixels around (u, v), or takes the nearest one where these do not belong
  /// to one surface. Inverse depth is interpolated: it is linear over the image of a plane. nullopt outside
  /// the image and where the nearest pixel has no depth.
  std::optional<DepthSample> at(double u, double v) const;

  /// Depth of a pixel; nullopt where it is invalid.
  std::optional<float> pixel_depth(int u, int v) const;

 private:
  Eigen::Vector3f pixel_colour(int u, int v) const;
  std::optional<DepthSample> interpolate(double u, double v) const;

  const DepthView& view_;
  int width_;
  int height_;
  float edge_;
};

}  // namespace surefield
