#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "engine/sources/depth_range.h"
#include "engine/sources/frame_stream.h"

namespace surefield {

/// The times at which the frames of a dataset were taken.
struct StampSurvey {
  bool indices = false;    ///< the stamps only number the frames
  double duration = 0;     ///< from first to last, seconds (or frame numbers)
  double spacing = 0;      ///< median, seconds (or frame numbers)
  int gaps = 0;            ///< places where at least one frame is missing
  int dropped = 0;         ///< frames missing there, as their length says
  double longest_gap = 0;  ///< seconds (or frame numbers)
  int disordered = 0;      ///< stamps that are not later than the one before
};

/// What reading a whole dataset tells.
struct DatasetSurvey {
  int frames = 0;  ///< those looked at
  std::vector<SkippedFrame> unreadable;
  int posed = 0;  ///< frames whose true pose is known
  int poses = 0;  ///< of the truth, those that are finite
  StampSurvey stamps;
  std::optional<DepthRange> depth;  ///< nothing where no frame has depth
};

/// The times alone; reads no image.
StampSurvey survey_stamps(const Recording& recording);

/// Reads every frame. `truth` is the true trajectory, null where there is none; `depth_max`, metres, is what
/// DepthRange::beyond counts from. `go_on` is told how many are done and ends the survey early by returning
/// false.
DatasetSurvey survey_dataset(const Recording& recording, const Trajectory* truth, double depth_max,
                             const std::function<bool(int)>& go_on = {});

}  // namespace surefield
