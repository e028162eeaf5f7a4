#pragma once

#include <optional>
#include <vector>

#include "engine/graph/pose_graph.h"
#include "engine/slam/loop_check.h"

namespace surefield {

/// Closes loops: recognises places that the newest keyframe sees again, and where the poses do not say so,
/// corrects all keyframes' poses, by a graph of what has been measured between them, and the map with them
/// (docs/places.md, "Loops").
class LoopCloser {
 public:
  /// All of them outlive it.
  LoopCloser(SplatEngine& engine, const SlamSettings& settings, const Intrinsics& intrinsics,
             KeyframeGraph& keyframes)
      : engine_(engine), keyframes_(keyframes), check_(engine, settings, intrinsics, keyframes, odometer_) {}

  /// There is a first keyframe, or another in its place.
  void begin();
  /// The newest keyframe is mapped and has its window; it was tracked after keyframe `before` (-1: none),
  /// with this covariance. Looks for places that it sees again; where it has come back to one that the poses
  /// do not lead to, corrects poses and map. Returns the keyframe that it has come back to then.
  std::optional<int> close(int before, const PoseCovariance& covariance);
  /// The second half of that, with what was judged of the newest keyframe: where the last of these says what
  /// one of a keyframe before it has said, corrects poses and map, unless the other measurements contradict.
  std::optional<int> follow(const std::vector<Loop>& judged);

  /// All that was judged, in the order of the newer keyframe.
  const std::vector<Loop>& loops() const { return loops_; }
  /// The other measurements between keyframes: from each to the one that it was tracked after.
  const std::vector<RelativePose>& odometry() const { return odometry_; }

 private:
  void add_odometry(int before, const PoseCovariance& covariance);
  std::vector<Loop> look() const;
  /// A place that was recognised twice, the same correction both times: the positions of both in loops_.
  std::optional<std::pair<std::size_t, std::size_t>> confirmed() const;
  bool correct();
  void apply(const PoseGraph& graph);

  SplatEngine& engine_;
  KeyframeGraph& keyframes_;
  Odometer odometer_;
  LoopCheck check_;
  std::vector<RelativePose> odometry_;
  std::vector<Loop> loops_;
  int rest_until_ = 0;  ///< no keyframe before this one looks for places
};

}  // namespace surefield
