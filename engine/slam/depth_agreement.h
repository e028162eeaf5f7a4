#pragma once

#include "engine/slam/loop.h"
#include "engine/slam/moved_things.h"

namespace surefield {

/// How much two views agree about depth, both ways, at these poses: two rooms that look alike do not, as soon
/// as something stands elsewhere. What the one sees behind something that the other sees says nothing.
DepthAgreement compare_depth(const DepthView& one, const DepthView& other, const DepthNoise& noise);

/// By how many pixels what `view` sees moves in its own image where its pose is `corrected`: the median over
/// its cells with depth; 0 where there are none.
double median_shift(const DepthView& view, const Pose& corrected);

}  // namespace surefield
