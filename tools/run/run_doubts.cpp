#include "tools/run/run_doubts.h"

#include <algorithm>

namespace surefield {

namespace {

constexpr int kLookedAt = 5;  // frames, all over the selection

}  // namespace

std::vector<std::string> find_doubts(const Recording& recording, const FrameSelection& selection,
                                     const DepthReach& reach) {
  std::vector<std::string> doubts = implausible(recording.intrinsics());
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
    doubts.insert(doubts.end(), more.begin(), more.end());
  }
  return doubts;
}

}  // namespace surefield
