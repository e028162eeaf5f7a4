#pragma once

#include <Eigen/Core>
#include <optional>

#include "engine/types/frame.h"
#include "engine/types/render_images.h"

namespace surefield {

/// The gains, one a channel, that bring a frame's colours to the exposure of the map: a camera that adapts to
/// the light shows the same surface brighter or darker, and by another white. From a render of the map at the
/// frame's pose: the ratio of the means of rendered and measured colour over the pixels where the map shows
/// the surface that the sensor sees, and where the sensor is neither dark nor saturated; pixels that fit
/// badly weigh little. None where too little of the frame is in the map. There is no bias beside the gains: a
/// render is softer than an image, and a line fitted between the two would take contrast from every
/// keyframe.
std::optional<Eigen::Vector3f> fit_gains(const Frame& frame, const RenderImages& rendered);

}  // namespace surefield
