#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/slam/slam.h"

namespace surefield {

/// "good", "poor" or "lost".
const char* name_of(TrackingState state);

/// What is known about one frame; the keys are the columns of frames.csv too.
nlohmann::ordered_json frame_json(const FrameReport& frame);

/// frames.csv: a line of names, then one of numbers for every frame fed. Yes is 1, no is 0.
std::string frames_csv(const std::vector<FrameReport>& frames);

}  // namespace surefield
