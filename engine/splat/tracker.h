#pragma once

#include "engine/splat/rasteriser.h"
#include "engine/splat/sensor_frame.h"
#include "shaders/shared/track_gradient.h"
#include "shaders/shared/track_limits.h"
#include "shaders/shared/track_residuals.h"
#include "shaders/shared/track_step.h"
#include "shaders/shared/track_sums.h"
#include "shaders/shared/track_total.h"

namespace surefield {

/// Finds the pose of a frame in a fixed map by Adam on {so(3)|T} (paper eq. 19 and 20). The pose, Adam's
/// state and the best pose live on the device; iterations are submitted several at a time.
class Tracker {
 public:
  explicit Tracker(gpu::Device& device);

  /// Tracks `frame` from the pose of `start`. Sets the rasteriser's kind of pose gradient.
  TrackingResult track(Rasteriser& rasteriser, const GaussianMap& map, const SensorFrame& frame,
                       const Camera& start, const TrackingSettings& settings);

  /// Records render, loss and dL/d(images) for the camera in `camera`: the gradient lands in
  /// rasteriser.pixel_upstream, the masked sums in `sums`.
  void record_loss(gpu::Recorder& recorder, Rasteriser& rasteriser, const GaussianMap& map,
                   const SensorFrame& frame, const TrackingSettings& settings);

  gpu::Array<glsl::CameraState> camera;  ///< the pose being tracked
  gpu::Array<glsl::TrackSums> sums;      ///< of the last record_loss()

 private:
  /// The passes that depend on which depth is compared.
  struct DepthPasses {
    gpu::Pass<passes::track_residuals> residuals;
    gpu::Pass<passes::track_gradient> gradient;
    DepthPasses(gpu::Device& device, uint32_t normalised);
  };
  void record_masks(gpu::Recorder& recorder, uint32_t pixels, double outlier_factor);
  void record_step(gpu::Recorder& recorder, const Rasteriser& rasteriser, const SensorFrame& frame,
                   const TrackingSettings& settings);

  gpu::Device& device_;
  DepthPasses alpha_;
  DepthPasses normalised_;
  gpu::Pass<passes::track_limits> limits_pass_;
  gpu::Pass<passes::track_sums> sums_pass_;
  gpu::Pass<passes::track_total> total_pass_;
  gpu::Pass<passes::track_step> step_pass_;
  gpu::Array<glsl::vec2> residuals_;
  gpu::Array<glsl::uint> histograms_;
  gpu::Array<glsl::vec2> limits_;
  gpu::Array<glsl::TrackSums> partial_sums_;
  gpu::Array<glsl::TrackState> state_;
};

}  // namespace surefield
