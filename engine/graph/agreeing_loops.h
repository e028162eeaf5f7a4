#pragma once

#include <vector>

#include "engine/types/relative_pose.h"

namespace surefield {

/// Which loops another one confirms: whether a second loop from near its one end to near the other end says
/// the same motion, with what `believed` edges say between the ends (at most two of them at each). The
/// motions may differ by what 99 of 100 right pairs do by their information. Vertices are those of the edges,
/// below `vertices`. Loops that are false at random are confirmed hardly ever, however much the poses have
/// drifted.
std::vector<bool> agreeing_loops(const std::vector<RelativePose>& believed,
                                 const std::vector<RelativePose>& loops, int vertices);

}  // namespace surefield
