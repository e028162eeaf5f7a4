#pragma once

#include <string>
#include <vector>

#include "engine/sources/frame_stream.h"
#include "engine/sources/plausibility.h"

namespace surefield {

/// What looks wrong about a recording before its first frame is fed, one line each: its intrinsics, and the
/// depths of a few of the selected frames by `reach`. Frames that cannot be read say nothing.
std::vector<std::string> find_doubts(const Recording& recording, const FrameSelection& selection,
                                     const DepthReach& reach);

}  // namespace surefield
