#pragma once

#include <Eigen/Core>
#include <span>

#include "engine/slam/colour_grid.h"
#include "engine/types/camera.h"
#include "engine/types/gaussian_cloud.h"
#include "engine/types/render_images.h"

namespace surefield {

/// A keyframe by whose colours a frame's exposure is told.
struct LitView {
  const ColourGrid& grid;
  Eigen::Vector3f gains;  ///< times these its colours are those of the map
  Camera camera;
};

/// The gains, one a channel, that bring a frame to the exposure of the map. Its cells are compared with those
/// of `references` that show the same places from `camera`, about where it was taken; the gains are medians.
/// They are 1 unless one of them differs from that by more than `least`, as a factor less 1. Where that is
/// not clear, since cells differ more among themselves or too few can be compared, they are `before`, those
/// of the frame before.
Eigen::Vector3f find_gains(const ColourGrid& frame, const Camera& camera, std::span<const LitView> references,
                           const Eigen::Vector3f& before, double least);

/// A copy of an RGB image with each channel times its gain, cut off at white.
cv::Mat apply_gains(const cv::Mat& colour, const Eigen::Vector3f& gains);

/// Where a frame that was darkened by `gains` had been saturated it says only that the place is at least so
/// bright. Makes those channels as bright as the map shows them in `rendered`, from the frame's own pose, so
/// that mapping does not learn them. `colour` is the darkened image.
void brighten_saturated(cv::Mat& colour, const RenderImages& rendered, const Eigen::Vector3f& gains);
/// Whether it has such pixels.
bool has_saturated(const cv::Mat& colour, const Eigen::Vector3f& gains);

/// Multiplies the colours of Gaussians, or of a render, by gains.
void scale_colours(GaussianCloud& cloud, const Eigen::Vector3f& gains);
void scale_colours(RenderImages& images, const Eigen::Vector3f& gains);

}  // namespace surefield
