#pragma once

#include <string>
#include <vector>

#include "engine/slam/slam.h"

namespace surefield {

/// loops.csv: a line of names, then one for every place that looked known; docs/evaluation.md describes the
/// columns. `frames` are the Frame::index of the keyframes.
std::string loops_csv(const std::vector<Loop>& loops, const std::vector<int>& frames);

}  // namespace surefield
