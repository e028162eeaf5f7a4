#pragma once

#include "engine/splat/rasteriser.h"
#include "engine/splat/sensor_frame.h"
#include "shaders/shared/track_gradient.h"
#include "shaders/shared/track_limits.h"
#include "shaders/shared/track_residuals.h"
#include "shaders/shared/track_sums.h"
#include "shaders/shared/track_total.h"

namespace surefield {

/// The frame's view from `camera`, as tracking renders it.
View tracking_view(const SensorFrame& frame, const gpu::Array<glsl::CameraState>& camera,
                   const TrackingSettings& settings);

/// The loss that tracking minimises (paper eq. 19): masked L1 of colour and depth between a render of the map
/// and a frame.
class TrackingLoss {
 public:
  explicit TrackingLoss(gpu::Device& device);

  /// Records render, masks and loss of a tracking_view() of the frame: the masked sums land in `sums`.
  void record(gpu::Recorder& recorder, Rasteriser& rasteriser, const GaussianMap& map, const View& view,
              const SensorFrame& frame, const TrackingSettings& settings);

  /// After record() of the same view: dL/d(images), which lands in rasteriser.pixel_upstream. The masks are
  /// constants in it.
  void record_gradient(gpu::Recorder& recorder, Rasteriser& rasteriser, const View& view,
                       const SensorFrame& frame, const TrackingSettings& settings);

  gpu::Array<glsl::TrackSums> sums;   ///< of the last record()
  gpu::Array<glsl::uint> histograms;  ///< of its residuals, and counts (RESIDUAL_EXPLAINED and after)

 private:
  /// The passes that depend on which depth is compared.
  struct DepthPasses {
    gpu::Pass<passes::track_residuals> residuals;
    gpu::Pass<passes::track_gradient> gradient;
    DepthPasses(gpu::Device& device, uint32_t normalised);
  };
  DepthPasses& passes_of(DepthKind depth) { return depth == DepthKind::Normalised ? normalised_ : alpha_; }
  void record_masks(gpu::Recorder& recorder, uint32_t pixels, double outlier_factor);

  DepthPasses alpha_;
  DepthPasses normalised_;
  gpu::Pass<passes::track_limits> limits_pass_;
  gpu::Pass<passes::track_sums> sums_pass_;
  gpu::Pass<passes::track_total> total_pass_;
  gpu::Array<glsl::vec2> residuals_;
  gpu::Array<glsl::vec2> limits_;
  gpu::Array<glsl::TrackSums> partial_sums_;
};

}  // namespace surefield
