#pragma once

#include <functional>

#include "engine/eval/warp_check.h"

namespace surefield {

/// What of a dataset is compared, and how it was made comparable.
struct PreparedScene {
  CheckScene scene;
  double scale = 1;                 ///< of the checked images relative to the dataset's
  bool stamps_are_indices = false;  ///< stamps count frames; how fast they were taken is unknown
};

/// `count` numbers from 0 to size - 1, or all of them where there are fewer, evenly spread.
std::vector<int> spread(int size, int count);

/// Whether the stamps of a recording are but the numbers of its frames.
bool stamps_are_indices(const Recording& recording);

/// Loads frames from all over the dataset, each with a later one that was seen from clearly elsewhere but
/// shows much of the same; without `truth` (null), or poses near the frames in it, just frames. Frames that
/// cannot be read are left out. Ends early, with what was loaded, when `stop` returns true.
PreparedScene prepare_scene(const Recording& recording, const Trajectory* truth,
                            const std::function<bool()>& stop);

}  // namespace surefield
