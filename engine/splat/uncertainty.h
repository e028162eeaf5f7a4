#pragma once

#include "engine/splat/rasteriser.h"
#include "engine/splat/sensor_frame.h"
#include "shaders/shared/judge_gaussians.h"
#include "shaders/shared/sum_uncertainty.h"

namespace surefield {

/// The uncertainty of single Gaussians over a window of keyframes (paper eq. 13), and what becomes of the
/// uncertain ones.
class UncertaintyJudge {
 public:
  explicit UncertaintyJudge(gpu::Device& device);

  /// Records: no view has been seen.
  void record_begin(gpu::Recorder& recorder, const GaussianMap& map);
  /// Records the render of a view and adds its pixels; nothing is added where the view has too little room.
  void record_view(gpu::Recorder& recorder, Rasteriser& rasteriser, const GaussianMap& map,
                   const SensorFrame& frame, const gpu::Array<glsl::CameraState>& camera,
                   const MappingSettings& settings);
  /// Records the verdict on all views since record_begin(): map.uncertainty of the Gaussians that dominated a
  /// pixel, and the opacity of the uncertain ones of these, with its moments.
  void record_verdict(gpu::Recorder& recorder, GaussianMap& map, const MappingSettings& settings);
  /// Gaussians that were uncertain at the last submitted verdict, be it on them or an earlier one.
  uint32_t read_uncertain() const;

  gpu::Array<glsl::UncertaintySum> sums;  ///< per Gaussian of the map

 private:
  gpu::Pass<passes::sum_uncertainty> sum_pass_;
  gpu::Pass<passes::judge_gaussians> judge_pass_;
  gpu::Array<glsl::uint> uncertain_;
};

}  // namespace surefield
