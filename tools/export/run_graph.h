#pragma once

#include "engine/io/g2o_file.h"
#include "tools/results/run_folder.h"

namespace surefield {

/// The keyframe graph of a run: its keyframes, numbered as in keyframes.txt, the first one fixed, and an edge
/// from each to the next with the motion that the run gave them. A run keeps no covariance of these motions:
/// each counts as known within 1 cm and half a degree. Keyframes whose pose is not known are left out. Throws
/// InputError where there is none.
G2oGraph graph_of_run(const RunFolder& run);

}  // namespace surefield
