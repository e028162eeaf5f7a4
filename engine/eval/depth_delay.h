#pragma once

#include <functional>
#include <memory>

#include "engine/sources/recording.h"

namespace surefield {

/// Opens a sequence with so many seconds added to the stamps of its depth images.
using OpenDelayed = std::function<std::unique_ptr<Recording>(double)>;

/// Seconds to be added to the stamps of depth images, so that they say when the images were taken; 0 where
/// nothing speaks against the stamps. For sequences whose depth images have stamps of their own: colour
/// images from all over the sequence are paired with depth images one earlier and one later too; where colour
/// and depth fit, colour edges are strong at the depth edges. It needs no poses. Where the camera hardly
/// moves, or the difference is not certain (four standard errors), the stamps are believed. `recording` is
/// the sequence with nothing added.
double estimate_depth_delay(const Recording& recording, const OpenDelayed& open);

}  // namespace surefield
