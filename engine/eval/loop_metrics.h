#pragma once

#include <vector>

#include "engine/eval/place_metrics.h"

namespace surefield {

/// What counts as a revisit, and how right a loop must be (docs/evaluation.md, "Loops").
struct LoopCriteria {
  double shared = 0.3;       ///< each sees at least this part of what the other sees
  int keyframes = 10;        ///< back at least so many
  double path = 1;           ///< and so many metres of path
  double turned = 1.047198;  ///< or so many radians of turning
  double closed_position = 0.05, closed_rotation = 0.034907;  ///< metres, radians: 5 cm, 2 degrees
  double false_position = 0.10, false_rotation = 0.087266;    ///< 10 cm, 5 degrees
};

/// What is claimed of two keyframes: by their positions, the motion from the frame of the one to that of the
/// other, T_to T_from^-1 of their world-to-camera poses.
struct LoopEdge {
  int from = 0;
  int to = 0;
  Pose from_to = Pose::Identity();
};

/// A time in which the camera sees again what it saw: keyframes from the first to the last, by position.
struct Revisit {
  int first = 0;
  int last = 0;
  bool closed = false;  ///< a right edge leads from it back
};

/// How loops that were accepted stand to the truth.
struct LoopMetrics {
  std::vector<Revisit> revisits;
  int closed = 0;      ///< of those
  int edges = 0;       ///< accepted
  int right = 0;       ///< of those, within what closes
  int wrong = 0;       ///< beyond what is false
  double largest = 0;  ///< error of position, metres
};

/// For each keyframe, at its true pose, what it shares (both ways, the less of the two) with each one before
/// it that lies far enough back to be revisited; 0 for the others.
KeyframeTable shared_on_return(const std::vector<PlaceView>& keyframes, const LoopCriteria& criteria = {});

/// The longest runs of keyframes that share enough with one far enough back.
std::vector<Revisit> find_revisits(const KeyframeTable& shared, const LoopCriteria& criteria = {});

/// Judges accepted edges. A revisit is closed by a right edge between a keyframe in it and any that lies far
/// enough back from there. Edges' positions are in range.
LoopMetrics measure_loops(const std::vector<PlaceView>& keyframes, const std::vector<LoopEdge>& accepted,
                          const LoopCriteria& criteria = {});

}  // namespace surefield
