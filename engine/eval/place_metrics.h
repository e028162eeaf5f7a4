#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "engine/types/camera.h"

namespace surefield {

/// What a camera saw from where, to judge which views show the same.
struct PlaceView {
  Camera camera;  ///< at its true pose
  cv::Mat depth;  ///< CV_32FC1, metres along camera z; 0 where invalid
};

/// The part of what `from` sees that `to` sees too, in [0, 1]: points of its depth that lie in the other's
/// image at the depth that is measured there, so that what is hidden does not count. Points at which the
/// other has no depth take no part.
double shared_view(const PlaceView& from, const PlaceView& to);

/// How many keyframes are looked up, and among which.
struct PlaceSettings {
  int count = 2;        ///< keyframes to find
  int gap = 2;          ///< among those at least so many before: 2 leaves out the one just before
  double shared = 0.3;  ///< two show the same when each sees at least this part of what the other sees
};

/// For each keyframe a row with a number for each one before it (more are ignored).
using KeyframeTable = std::vector<std::vector<double>>;

/// How well keyframes that show the same were found. NaN where there was nothing to find.
struct PlaceMetrics {
  int queries = 0;   ///< keyframes for which there was one to find
  double found = 0;  ///< of the `count` places (of fewer where there are fewer to find), part that was filled
                     ///< with keyframes that show the same; mean over the queries
  double recall = 0;  ///< part of all keyframes that show the same; mean over the queries
};

/// Looks up, for each keyframe, those before it of the highest scores, none whose score is not positive; of
/// equals the more recent. `shared` is the part that both see of the other.
PlaceMetrics measure_places(const KeyframeTable& scores, const KeyframeTable& shared,
                            const PlaceSettings& settings);

}  // namespace surefield
