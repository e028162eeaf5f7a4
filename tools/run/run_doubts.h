#pragma once

#include <string>
#include <vector>

#include "engine/sources/frame_stream.h"
#include "engine/sources/plausibility.h"

namespace surefield {

/// What a look at a recording tells before its first frame is fed.
struct FirstLook {
  std::vector<std::string> doubts;  ///< what looks wrong, one line each
  double beyond = 0;                ///< share of the depths that lie beyond the limit, and so are not used
};

/// What looks wrong about a recording before its first frame is fed: its intrinsics, and the
/// depths of a few of the selected frames by `reach`. Frames that cannot be read say nothing.
FirstLook look_first(const Recording& recording, const FrameSelection& selection, const DepthReach& reach);

}  // namespace surefield
