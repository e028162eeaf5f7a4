#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/eval/warp_check.h"

namespace surefield {

/// What can be found to be wrong with a dataset's calibration.
enum class CheckedValue {
  DepthScale,
  FocalLength,
  FocalRatio,
  PoseDelay,
  DepthFocal,
  DepthShiftX,
  DepthShiftY,
  DepthDelay
};

/// How one value was judged.
struct Judgement {
  CheckedValue value = CheckedValue::DepthScale;
  bool judged = false;     ///< false where frames, motion or depth edges do not suffice
  bool wrong = false;      ///< the best value is far from what the dataset says, and clearly better
  double best = 0;         ///< the best value as in Correction, but shifts in pixels of the dataset's images
  double improvement = 0;  ///< of the error, or of the edge strength, at the best value: a fraction
  double certainty = 0;    ///< mean improvement over pairs or frames by its standard error
};

/// What comparing frames by the true poses says about a dataset.
struct DatasetCheck {
  bool has_poses = false;  ///< else only depth edges and colour edges could be compared
  bool stamps_are_indices = false;
  WarpError error;                    ///< as the dataset stands
  Correction correction;              ///< what was found wrong; shifts in pixels of the checked images
  std::vector<Judgement> judgements;  ///< one for each CheckedValue, in their order
};

/// Warps frames into later ones by the true poses, and lays depth edges on colour edges, to tell whether
/// depth scale, intrinsics, registration and stamps fit: each value is varied alone, the one that explains
/// most is corrected, and the others are judged again. Loads up to some 50 frames. `truth` is the true
/// trajectory, null where there is none. `stop` is asked now and then, and ends the check early when it
/// returns true.
DatasetCheck check_dataset(const Recording& recording, const Trajectory* truth,
                           const std::function<bool()>& stop = {});

/// One line for each thing that was found wrong: what it is and what to change.
std::vector<std::string> check_findings(const DatasetCheck& check, const Recording& recording);

}  // namespace surefield
