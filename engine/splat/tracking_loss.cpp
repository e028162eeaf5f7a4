#include "engine/splat/tracking_loss.h"

namespace surefield {

View tracking_view(const SensorFrame& frame, const gpu::Array<glsl::CameraState>& camera,
                   const TrackingSettings& settings) {
  View view{.size = frame.size, .camera = camera, .sensor_depth = frame.depth};
  if (settings.uncertainty_above > 0) view.uncertainty_above = static_cast<float>(settings.uncertainty_above);
  return view;
}

TrackingLoss::DepthPasses::DepthPasses(gpu::Device& device, uint32_t normalised)
    : residuals(device, gpu::kWorkgroup, {.NORMALISED_DEPTH = normalised}),
      gradient(device, gpu::kWorkgroup, {.NORMALISED_DEPTH = normalised}) {}

TrackingLoss::TrackingLoss(gpu::Device& device)
    : sums(device, "tracking sums"),
      histograms(device, "residual histograms", glsl::RESIDUAL_COUNTS),
      alpha_(device, 0),
      normalised_(device, 1),
      limits_pass_(device, gpu::kWorkgroup),
      sums_pass_(device, gpu::kWorkgroup),
      total_pass_(device, gpu::kWorkgroup),
      residuals_(device, "residuals"),
      limits_(device, "residual limits"),
      partial_sums_(device, "partial tracking sums") {}

void TrackingLoss::record_masks(gpu::Recorder& recorder, uint32_t pixels, double outlier_factor) {
  const uint32_t strips = (pixels + glsl::SUM_STRIP - 1) / glsl::SUM_STRIP;
  recorder.reserve(partial_sums_, strips);
  recorder.dispatch(limits_pass_, 1, {.histograms = histograms, .limits = limits_},
                    {.outlier_factor = static_cast<float>(outlier_factor)});
  recorder.dispatch(sums_pass_, sums_pass_.groups(strips),
                    {.residuals = residuals_, .limits = limits_, .partial_sums = partial_sums_},
                    {.pixels = pixels});
  recorder.dispatch(total_pass_, 1, {.partial_sums = partial_sums_, .sums = sums}, {.count = strips});
}

void TrackingLoss::record(gpu::Recorder& recorder, Rasteriser& rasteriser, const GaussianMap& map,
                          const View& view, const SensorFrame& frame, const TrackingSettings& settings) {
  const auto pixels = static_cast<uint32_t>(frame.size.pixels());
  const auto& pass = passes_of(settings.depth).residuals;
  recorder.reserve(residuals_, pixels);
  rasteriser.record_forward(recorder, map, view, Outputs::ColourDepth);
  recorder.fill(histograms, glsl::RESIDUAL_COUNTS, 0);
  recorder.dispatch(pass, pass.groups(pixels),
                    {.colour_opacity = rasteriser.colour_opacity,
                     .geometry = rasteriser.geometry,
                     .sensor_colour = frame.colour,
                     .sensor_depth = frame.depth,
                     .residuals = residuals_,
                     .histograms = histograms},
                    {.pixels = pixels,
                     .minimum_opacity = static_cast<float>(settings.minimum_opacity),
                     .noise = frame.noise});
  record_masks(recorder, pixels, settings.outlier_factor);
}

void TrackingLoss::record_gradient(gpu::Recorder& recorder, Rasteriser& rasteriser, const View& view,
                                   const SensorFrame& frame, const TrackingSettings& settings) {
  const auto pixels = static_cast<uint32_t>(frame.size.pixels());
  const auto& pass = passes_of(settings.depth).gradient;
  recorder.dispatch(pass, pass.groups(pixels),
                    {.colour_opacity = rasteriser.colour_opacity,
                     .geometry = rasteriser.geometry,
                     .sensor_colour = frame.colour,
                     .sensor_depth = frame.depth,
                     .residuals = residuals_,
                     .limits = limits_,
                     .sums = sums,
                     .pixel_upstream = rasteriser.pixel_upstream},
                    {.pixels = pixels,
                     .weight_colour = static_cast<float>(settings.weight_colour),
                     .weight_depth = static_cast<float>(settings.weight_depth),
                     .background = to_vec3(view.background)});
}

}  // namespace surefield
