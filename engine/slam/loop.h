#pragma once

#include <utility>
#include <vector>

#include "engine/types/relative_pose.h"

namespace surefield {

/// What became of a place that looked known (docs/places.md, "Loops").
enum class LoopVerdict {
  Accepted,      ///< it is that place: the poses were corrected by it
  Agreed,        ///< it is, and the poses say so already, as well as can be measured
  Waiting,       ///< it seems to be; no keyframe beside it has said the same yet
  FewMatches,    ///< features that one motion lays on each other are too few
  Clustered,     ///< those lie in one corner of the image
  Unaligned,     ///< aligned to the keyframes beside it, the camera is elsewhere
  LittleShared,  ///< too little of what the one sees is in the other's image
  OtherDepth,    ///< where both have depth they differ
  SeenThrough,   ///< the one looks through what the other shows: another place that looks alike
  TooFar,        ///< so much the camera cannot have drifted
  Contradicted   ///< the other measurements speak against it: taken back after the poses were corrected
};

/// A word for it, as loops.csv has it.
const char* name_of(LoopVerdict verdict);

/// How much the images of two keyframes agree where one motion lays them on each other; shares of cells.
struct DepthAgreement {
  double shared = 0;    ///< of the cells with depth of one, those in the other's image; the larger of both
  double agreeing = 0;  ///< of the cells in both with depth in both: equal depth
  double seen_through = 0;  ///< of those that are not hidden: the other measured beyond; the larger of both
};

/// A place that looked known, and how it was judged. The keyframes are named by their positions among all.
struct Loop {
  /// From the old keyframe to the new one; the pose and its information are those of an alignment, as far as
  /// the judgement got.
  RelativePose measured;
  double similarity = 0;  ///< of the images, a cosine; 0 where the place was looked up by its pose
  int inliers = 0;        ///< features that one motion lays on each other
  DepthAgreement depth;
  double correction_position = 0;  ///< by which the new keyframe's pose is off then, metres
  double correction_rotation = 0;  ///< radians
  double correction_pixels = 0;    ///< by how much what it sees moves in its image then, the median
  /// The squared correction in deviations of the measurement; below 12.6 in 19 of 20 cases where the poses
  /// are right.
  double correction_chi2 = 0;
  LoopVerdict verdict = LoopVerdict::FewMatches;

  /// Whether it is taken for true.
  bool counts() const { return verdict == LoopVerdict::Accepted || verdict == LoopVerdict::Agreed; }
};

/// The pairs of keyframes, the older one first, of the loops that are taken for true.
std::vector<std::pair<int, int>> links_of(const std::vector<Loop>& loops);

}  // namespace surefield
