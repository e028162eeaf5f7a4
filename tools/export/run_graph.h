#pragma once

#include "engine/io/g2o_file.h"
#include "tools/results/run_folder.h"

namespace surefield {

/// The keyframe graph of a run: its keyframes, numbered as in keyframes.txt, the first one fixed, an edge
/// from each to the next with the motion that the run gave them, and behind these the accepted loops of
/// loops.csv, where there is one, with what they measured. A run keeps no covariance of the motions between
/// neighbours: each counts as known within 1 cm and half a degree. Keyframes whose pose is not known are left
/// out, with their loops. Throws InputError where there is none, or where loops.csv is damaged, has no
/// information or names a frame that is no keyframe.
G2oGraph graph_of_run(const RunFolder& run);

}  // namespace surefield
