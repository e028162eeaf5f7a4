#include "tools/run/run_doubts.h"

#include <algorithm>

namespace surefield {

namespace {

constexpr int kLookedAt = 5;  // frames, all over the selection

}  // namespace

FirstLook look_first(const Recording& recording, const FrameSelection& selection, const DepthReach& reach) {
  FirstLook look{implausible(recording.intrinsics())};
  const int available = (recording.count() - selection.start - 1) / selection.stride + 1;
  const int count = selection.frames > 0 ? std::min(selection.frames, available) : available;
  DepthHistogram depths;
  for (int k = 0; k < std::min(kLookedAt, count); ++k) {
    const int position = count <= kLookedAt ? k : k * (count - 1) / (kLookedAt - 1);
    const LoadedFrame loaded = recording.load(selection.start + position * selection.stride);
    if (loaded.frame) depths.add(loaded.frame->depth);
  }
  if (const auto range = depths.range(reach.limit)) {
    const auto more = implausible(*range, recording.depth_unit(), reach);
    look.doubts.insert(look.doubts.end(), more.begin(), more.end());
    look.beyond = range->beyond;
  }
  return look;
}

}  // namespace surefield
