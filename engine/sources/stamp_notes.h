#pragma once

#include <string>
#include <vector>

#include "engine/types/trajectory.h"

namespace surefield {

/// What is odd about the stamps of the frames (seconds, in their order) and of the true poses (or null), a
/// line each: stamps that repeat, and true poses of which none is near a frame.
std::vector<std::string> notes_on_stamps(const std::vector<double>& stamps, const Trajectory* truth);

}  // namespace surefield
