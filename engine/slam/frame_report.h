#pragma once

#include <cstdint>

#include "engine/slam/pose_covariance.h"
#include "engine/types/camera.h"

namespace surefield {

/// How far a frame's pose is to be trusted (docs/method.md, "Knowing when it is wrong").
enum class TrackingState {
  Good,
  Poor,  ///< uncertain, or the map explains too little of the frame: it becomes no keyframe
  Lost   ///< not known: the pose is the last one that was
};

/// What happened to one frame.
struct FrameReport {
  int index = 0;         ///< Frame::index
  double timestamp = 0;  ///< seconds
  Pose world_to_camera = Pose::Identity();
  bool keyframe = false;
  TrackingState state = TrackingState::Good;
  int retries = 0;  ///< other starting poses that were tried
  /// The keyframe, by its position among them, at which the camera was found again after it had been lost or
  /// carried elsewhere; -1: none.
  int found_at = -1;
  /// Times these, one a channel, its colours are those of the map; 1 where the light is steady
  /// (docs/method.md, "Light"). Of a run that is finished, the map with the exposure that Slam::map() gives
  /// it.
  Eigen::Vector3f gains = Eigen::Vector3f::Ones();
  double tracking_loss = 0;
  double valid_fraction = 0;  ///< pixels that took part in tracking, of those with sensor depth
  double explained = 0;       ///< pixels whose depth the map explains, of those with sensor depth
  double seen_through = 0;    ///< pixels where the sensor sees through the map, of those
  double moved = 0;  ///< of all pixels, those that were taken out of a keyframe since something moves there
  /// Of the pose relative to the keyframes that it was aligned to, for a small motion of the camera in its
  /// own frame: translation (metres), then rotation (radians). Zeros where it is not known: for the first
  /// frame, and where tracking is by Adam.
  PoseCovariance covariance = PoseCovariance::Zero();
  int tracking_iterations = 0;
  double tracking_ms = 0;
  int mapping_iterations = 0;
  double mapping_ms = 0;
  double loops_ms = 0;     ///< of a keyframe: looking for its place among those seen before, and correcting
  uint32_t gaussians = 0;  ///< in the map after this frame
  uint32_t uncertain_gaussians = 0;  ///< on the device when the frame's mapping judged them
  uint32_t device_gaussians = 0;     ///< of these, on the device
  uint64_t device_bytes = 0;         ///< device memory in use after this frame

  bool lost() const { return state == TrackingState::Lost; }
};

}  // namespace surefield
