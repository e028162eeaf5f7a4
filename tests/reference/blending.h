#pragma once

#include <span>
#include <vector>

#include "tests/reference/projection.h"

namespace surefield::reference {

/// Indices of the Gaussians that may be blended, near to far by z, ties by index. Those culled within the
/// margin of the near plane are among them, so that decide_pixel() can flag the pixels they might have
/// touched.
std::vector<int> depth_order(const std::vector<Projection>& projections);

/// Takes the discrete decisions of one pixel, and flags in `images` those which lie within the margins of
/// `settings`.
PixelDecisions decide_pixel(const Gaussians& gaussians, const std::vector<Projection>& projections,
                            const std::vector<int>& order, const Settings& settings, int x, int y,
                            Images& images);

/// Blends pixel (x, y) as `decisions` say into the images.
void blend_pixel(const std::vector<Projection>& projections, const PixelDecisions& decisions,
                 float sensor_depth, const Settings& settings, int x, int y, Images& images);

/// Adds to `gradients` (one per Gaussian) what the images' derivatives `upstream` at pixel (x, y) contribute.
/// Leaves ProjectionGradient::covariance to whoever has all pixels' sum of the conic.
void blend_pixel_backward(const std::vector<Projection>& projections, const PixelDecisions& decisions,
                          float sensor_depth, const Settings& settings, int x, int y,
                          const ImageGradients& upstream, std::vector<ProjectionGradient>& gradients);

}  // namespace surefield::reference
