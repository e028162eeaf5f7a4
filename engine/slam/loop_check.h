#pragma once

#include "engine/slam/loop.h"
#include "engine/slam/loop_candidates.h"

namespace surefield {

/// What two aligned keyframes tell of each other: their covariance, and what no alignment knows better than (a
/// millimetre and half a per cent of the depth), as information.
Matrix6 pair_information(const PoseCovariance& covariance, const Keyframe& seen);

/// Judges whether the newest keyframe sees the place of an older one, from what is cheap to what is dear:
/// features, alignment to the keyframes around it, depth, and whether the camera can have drifted so far.
class LoopCheck {
 public:
  /// All of them outlive it.
  LoopCheck(SplatEngine& engine, const SlamSettings& settings, const Intrinsics& intrinsics,
            const KeyframeGraph& keyframes, const Odometer& odometer)
      : engine_(engine),
        settings_(settings),
        intrinsics_(intrinsics),
        keyframes_(keyframes),
        odometer_(odometer) {}

  /// Waiting where it does, Agreed where the poses say so already.
  Loop judge(const LoopCandidate& candidate) const;

 private:
  std::optional<Pose> first_pose(const LoopCandidate& candidate, Loop& loop) const;
  bool align(int place, Pose& pose, Loop& loop) const;
  bool has_same_depth(int place, const Pose& pose, Loop& loop) const;
  bool is_near(int place, const Pose& pose, Loop& loop) const;

  SplatEngine& engine_;
  const SlamSettings& settings_;
  const Intrinsics intrinsics_;
  const KeyframeGraph& keyframes_;
  const Odometer& odometer_;
};

}  // namespace surefield
