#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "engine/sources/recording.h"

namespace surefield {

/// A point of a surface that two frames show, and its depth in both.
struct PointMatch {
  Eigen::Vector2d from;   ///< pixels of the first frame, original size
  Eigen::Vector2d to;     ///< pixels of the second
  double from_depth = 0;  ///< metres
  double to_depth = 0;    ///< metres
};

/// Two frames that see much of the same from elsewhere, by their numbers in the recording.
struct MatchedFrames {
  int from = 0;
  int to = 0;
  std::vector<PointMatch> points;
};

/// Is told how much is done, in [0, 1]; false ends the work.
using GoOn = std::function<bool(double)>;

/// Matches frames all over the recording with later ones, by the features of their images: each with one as
/// late as still shows enough of the same. Knows nothing of poses, and nothing of the intrinsics but the
/// size: what does not fit one motion of one camera, whatever its focal lengths, is left out. Points near
/// depth edges are not used. Loads up to some 60 frames; those that cannot be read are passed over.
std::vector<MatchedFrames> match_frames(const Recording& recording, const GoOn& go_on = {});

}  // namespace surefield
