#pragma once

#include "engine/slam/settings.h"
#include "engine/types/frame.h"
#include "engine/types/gaussian_cloud.h"
#include "engine/types/render_images.h"

namespace surefield {

/// Size of the scene that rates and scales are measured by, metres: the depth that nine tenths of the first
/// frame lie within. Throws InputError where it has no valid depth.
double scene_extent(const Frame& frame);

/// New Gaussians for what `frame` sees and the map does not show (paper section 3.3): for the pixels with
/// valid depth whose rendered opacity is low, or that lie well in front of the rendered surface. `rendered`
/// is null for the first frame: every valid pixel spawns. Each stands for a pixel, or for a square of them
/// (birth_cells.h): a disc on the surface that the depth around shows, of about their footprint; a sphere
/// where that shows none. It has their mean colour times `gains` (exposure.h).
GaussianCloud spawn_gaussians(const Frame& frame, const Camera& camera, const RenderImages* rendered,
                              const SpawnSettings& settings,
                              const Eigen::Vector3f& gains = Eigen::Vector3f::Ones());

}  // namespace surefield
