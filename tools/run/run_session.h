#pragma once

#include "engine/session/run_observer.h"
#include "tools/results/run_configuration.h"

namespace surefield {

/// Runs SLAM over a dataset as the options ask and writes trajectory.txt, keyframes.txt, map.ply,
/// metrics.json, frames.csv, config.yaml and log.txt into the folder of the results; returns the exit code.
/// An error in the middle is thrown after what was computed so far has been saved.
int run_session(const RunOptions& options, const RunObservers& observers = {});

}  // namespace surefield
