#pragma once

#include <string>

#include "engine/session/results_folder.h"
#include "engine/slam/slam.h"
#include "engine/sources/frame_source.h"

namespace surefield {

/// Saves what a run has computed so far: trajectory.txt, trajectory_online.txt (each pose as it was when its
/// frame came) and keyframes.txt (TUM format, camera to world, of the camera that ground truth describes), the
/// map in `map_format`, one of run_map_formats(), frames.csv and loops.csv. A map that an earlier run left in another format is removed. What cannot be saved is in
/// results.problems().
void save_run(ResultsFolder& results, const Slam& slam, const FrameSource& source,
              const std::string& map_format = "ply");

}  // namespace surefield
