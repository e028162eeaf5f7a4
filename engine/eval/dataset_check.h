#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/eval/depth_delay.h"
#include "engine/eval/lens_fit.h"
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

/// How one value was judged. Shifts are in pixels of the dataset's images, delays in seconds, or in frames
/// where the stamps only number the frames, all others are factors.
struct Judgement {
  CheckedValue value = CheckedValue::DepthScale;
  bool judged = false;     ///< whether a fault of a size that matters would have been seen
  bool wrong = false;      ///< the best value is far from what the dataset says, and clearly better
  double best = 0;         ///< the best value as in Correction
  double lower = 0;        ///< values below it fit clearly worse; -infinity (factors: 0) where none does
  double upper = 0;        ///< values above it fit clearly worse; infinity where none does
  double improvement = 0;  ///< of the error, or of the edge strength, at the best value: a fraction
  double certainty = 0;    ///< mean improvement over pairs or frames by its standard error
};

/// What comparing frames says about a dataset.
struct DatasetCheck {
  bool has_poses = false;  ///< else nothing could be warped by true poses
  bool stamps_are_indices = false;
  WarpError error;                    ///< as the dataset stands
  Correction correction;              ///< what was found wrong; shifts in pixels of the checked images
  std::vector<Judgement> judgements;  ///< one for each CheckedValue, in their order
  LensFit lens;                       ///< by matched points; where poses did not tell the focal lengths
  DepthDelay depth_delay;             ///< by edges alone; where poses did not tell it
};

/// Warps frames into later ones by the true poses, and lays depth edges on colour edges, to tell whether
/// depth scale, intrinsics, registration and stamps fit: each value is varied alone, the one that explains
/// most is corrected, and the others are judged again. What needs poses and has none is judged by points
/// that frames share (fit_lens) and by the depth images before and after (estimate_depth_delay), but for the
/// scale of depth. Loads up to some 50 frames, and without poses 200 more. `truth` is the true trajectory,
/// null where there is none. `go_on` is told now and then how much is done, in [0, 1], and ends the check
/// early by returning false.
DatasetCheck check_dataset(const Recording& recording, const Trajectory* truth, const GoOn& go_on = {});

}  // namespace surefield
