#pragma once

#include <vector>

#include "engine/slam/keyframe_graph.h"

namespace surefield {

/// A keyframe that may show the place of the newest one.
struct LoopCandidate {
  int keyframe = 0;
  double similarity = 0;  ///< of the images; 0 where it was not found by that
};

/// How far the camera has come, by the keyframes' poses: tells a place left and found again from one that was
/// never left.
class Odometer {
 public:
  /// The newest keyframe was added, and comes after keyframe `before` (-1: none).
  void add(const KeyframeGraph& keyframes, int before);

  double path(int from, int to) const { return path_[to] - path_[from]; }   ///< metres
  double turned(int from, int to) const { return turned_[to] - turned_[from]; }  ///< radians
  /// Whether a keyframe that sees the place of `from` in `to` has come back to it.
  bool has_left(int from, int to) const;

 private:
  std::vector<double> path_, turned_;
};

/// The keyframes of places left long ago that look like what the newest one sees, the most alike first, then
/// those that see most of the same at the poses as they are thought to be.
std::vector<LoopCandidate> find_candidates(const KeyframeGraph& keyframes, const Odometer& odometer);

}  // namespace surefield
