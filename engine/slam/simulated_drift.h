#pragma once

#include <deque>

#include "engine/slam/settings.h"
#include "engine/types/camera.h"

namespace surefield {

/// Makes tracking drift by a known twist a frame, for tests of loops. The camera turns about its centre and
/// moves, both in directions that stay the same in the world, so that the error grows evenly. Without this,
/// what a frame is aligned to would hold the camera where it was: keyframes older than the newest are
/// therefore seen as if they had drifted with it.
class SimulatedDrift {
 public:
  /// `settings` may change from frame to frame.
  explicit SimulatedDrift(const DriftSettings& settings) : settings_(settings) {}

  bool none() const { return settings_.rotation == 0 && settings_.translation == 0; }

  /// The pose of a frame, world to camera, so many frames after the keyframe in whose world it was tracked.
  Pose drifted(const Pose& world_to_camera, double frames) const;
  /// There is a new keyframe, of this pose, so many frames after the one before it.
  void begin_keyframe(const Pose& world_to_camera, double frames);
  /// The pose of the keyframe that is `older` before the newest, as a frame is to see it that is tracked in
  /// the world of the newest.
  Pose seen_from_newest(const Pose& world_to_camera, int older) const;

 private:
  const DriftSettings& settings_;
  std::deque<Pose> steps_;  ///< motion of the world from keyframe to keyframe, the newest first
};

}  // namespace surefield
