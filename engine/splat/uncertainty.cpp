#include "engine/splat/uncertainty.h"

#include <cmath>

namespace surefield {

UncertaintyJudge::UncertaintyJudge(gpu::Device& device)
    : sums(device, "uncertainty sums"),
      sum_pass_(device, gpu::kWorkgroup),
      judge_pass_(device, gpu::kWorkgroup),
      uncertain_(device, "uncertain Gaussians", 1) {}

void UncertaintyJudge::record_begin(gpu::Recorder& recorder, const GaussianMap& map) {
  recorder.reserve(sums, map.size());
  recorder.fill(sums, map.size(), 0);
}

void UncertaintyJudge::record_view(gpu::Recorder& recorder, Rasteriser& rasteriser, const GaussianMap& map,
                                   const SensorFrame& frame, const gpu::Array<glsl::CameraState>& camera,
                                   const MappingSettings& settings) {
  rasteriser.record_forward(recorder, map, {frame.size, camera, frame.depth}, Outputs::All);
  const auto pixels = static_cast<uint32_t>(frame.size.pixels());
  recorder.dispatch(
      sum_pass_, sum_pass_.groups(pixels),
      {.status = rasteriser.lists.status,
       .sensor_depth = frame.depth,
       .dominators = rasteriser.dominators,
       .geometry = rasteriser.geometry,
       .splats = rasteriser.lists.splats,
       .sums = sums},
      {.pixels = pixels, .above = static_cast<float>(settings.uncertainty_above), .noise = frame.noise});
}

void UncertaintyJudge::record_verdict(gpu::Recorder& recorder, GaussianMap& map,
                                      const MappingSettings& settings) {
  const double opacity = settings.uncertain_opacity;
  recorder.fill(uncertain_, 1, 0);
  recorder.dispatch(judge_pass_, judge_pass_.groups(map.size()),
                    {.sums = sums,
                     .uncertainty = map.uncertainty,
                     .opacity_logits = map.opacity_logits.value,
                     .opacity_logits_m = map.opacity_logits.first_moment,
                     .opacity_logits_v = map.opacity_logits.second_moment,
                     .uncertain = uncertain_},
                    {.count = map.size(),
                     .above = static_cast<float>(settings.uncertainty_above),
                     .logit = static_cast<float>(std::log(opacity / (1 - opacity)))});
}

uint32_t UncertaintyJudge::read_uncertain() const {
  return uncertain_.download(1)[0];
}

}  // namespace surefield
