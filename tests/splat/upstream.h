#pragma once

#include "engine/types/render_images.h"
#include "shaders/shared/splat_types.h"
#include "tests/reference/types.h"

namespace surefield::testing {

/// What lib/pixel_upstream.glsl makes of dL/d(images) at pixel `i`, in double precision up to the last step.
/// `images` as the device rendered them, without invalid sensor depth in U.
inline glsl::PixelUpstream upstream_at(const reference::ImageGradients& g, const RenderImages& images,
                                       std::size_t i, const std::array<double, 3>& background = {}) {
  const double opacity = images.opacity[i], depth = images.depth[i];
  const double normalised = opacity > 0 ? g.depth_normalised[i] / opacity : 0;
  const double g_depth = g.depth[i] + normalised;
  double constant = g.opacity[i] - (opacity > 0 ? normalised * depth / opacity : 0);
  double total = g_depth * depth + g.uncertainty[i] * images.uncertainty[i];
  for (std::size_t k = 0; k < 3; ++k) {
    constant -= g.colour[3 * i + k] * background[k];
    total += g.colour[3 * i + k] * (images.colour[3 * i + k] - (1 - opacity) * background[k]);
  }
  total += constant * opacity;
  const auto single = [](double x) { return static_cast<float>(x); };
  return {.colour = {single(g.colour[3 * i]), single(g.colour[3 * i + 1]), single(g.colour[3 * i + 2])},
          .depth = single(g_depth),
          .constant = single(constant),
          .total = single(total),
          .median = single(g.depth_median[i]),
          .uncertainty = single(g.uncertainty[i])};
}

}  // namespace surefield::testing
