#pragma once

#include "engine/splat/tracking_loss.h"
#include "shaders/shared/track_step.h"

namespace surefield {

/// Finds the pose of a frame in a fixed map by Adam on {so(3)|T} (paper eq. 19 and 20). The pose, Adam's
/// state and the best pose live on the device; iterations are submitted several at a time.
class AdamTracker {
 public:
  explicit AdamTracker(gpu::Device& device);

  /// Tracks `frame` from the pose of `start`.
  TrackingResult track(Rasteriser& rasteriser, TrackingLoss& loss, const GaussianMap& map,
                       const SensorFrame& frame, const Camera& start, const TrackingSettings& settings);

 private:
  void record_step(gpu::Recorder& recorder, const Rasteriser& rasteriser, const TrackingLoss& loss,
                   const SensorFrame& frame, const TrackingSettings& settings);

  gpu::Device& device_;
  gpu::Pass<passes::track_step> step_pass_;
  gpu::Array<glsl::CameraState> camera_;
  gpu::Array<glsl::TrackState> state_;
};

}  // namespace surefield
