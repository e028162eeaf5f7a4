#include "engine/slam/loop.h"

namespace surefield {

const char* name_of(LoopVerdict verdict) {
  switch (verdict) {
    case LoopVerdict::Accepted:
      return "accepted";
    case LoopVerdict::Agreed:
      return "agreed";
    case LoopVerdict::Waiting:
      return "waiting";
    case LoopVerdict::FewMatches:
      return "few matches";
    case LoopVerdict::Clustered:
      return "clustered";
    case LoopVerdict::Unaligned:
      return "unaligned";
    case LoopVerdict::LittleShared:
      return "little shared";
    case LoopVerdict::OtherDepth:
      return "other depth";
    case LoopVerdict::SeenThrough:
      return "seen through";
    case LoopVerdict::TooFar:
      return "too far";
    default:
      return "contradicted";
  }
}

std::vector<std::pair<int, int>> links_of(const std::vector<Loop>& loops) {
  std::vector<std::pair<int, int>> links;
  for (const Loop& loop : loops)
    if (loop.counts()) links.emplace_back(loop.measured.from, loop.measured.to);
  return links;
}

}  // namespace surefield
