#include "engine/splat/tracker.h"

#include <algorithm>
#include <chrono>
#include <limits>

namespace surefield {

namespace {

constexpr uint32_t kWorkgroup = 64;
// Iterations per submission: enough to hide the cost of submitting, few enough to stop in time.
constexpr int kBatch = 5;

}  // namespace

Tracker::DepthPasses::DepthPasses(gpu::Device& device, uint32_t normalised)
    : residuals(device, kWorkgroup, {.NORMALISED_DEPTH = normalised}),
      gradient(device, kWorkgroup, {.NORMALISED_DEPTH = normalised}) {}

Tracker::Tracker(gpu::Device& device)
    : camera(device, "tracked camera"),
      sums(device, "tracking sums"),
      device_(device),
      alpha_(device, 0),
      normalised_(device, 1),
      limits_pass_(device, kWorkgroup),
      sums_pass_(device, kWorkgroup),
      total_pass_(device, kWorkgroup),
      step_pass_(device, device.limits().subgroup_size),
      residuals_(device, "residuals"),
      histograms_(device, "residual histograms", 2 * glsl::RESIDUAL_BINS),
      limits_(device, "residual limits"),
      partial_sums_(device, "partial tracking sums"),
      state_(device, "tracking state") {}

void Tracker::record_masks(gpu::Recorder& recorder, uint32_t pixels, double outlier_factor) {
  const uint32_t strips = (pixels + glsl::SUM_STRIP - 1) / glsl::SUM_STRIP;
  recorder.reserve(partial_sums_, strips);
  recorder.dispatch(limits_pass_, 1, {.histograms = histograms_, .limits = limits_},
                    {.outlier_factor = static_cast<float>(outlier_factor)});
  recorder.dispatch(sums_pass_, sums_pass_.groups(strips),
                    {.residuals = residuals_, .limits = limits_, .partial_sums = partial_sums_},
                    {.pixels = pixels});
  recorder.dispatch(total_pass_, 1, {.partial_sums = partial_sums_, .sums = sums}, {.count = strips});
}

void Tracker::record_loss(gpu::Recorder& recorder, Rasteriser& rasteriser, const GaussianMap& map,
                          const SensorFrame& frame, const TrackingSettings& settings) {
  const auto pixels = static_cast<uint32_t>(frame.size.pixels());
  auto& passes = settings.depth == DepthKind::Normalised ? normalised_ : alpha_;
  recorder.reserve(residuals_, pixels);
  rasteriser.record_forward(recorder, map, {frame.size, camera, frame.depth}, Outputs::ColourDepth);
  recorder.fill(histograms_, 2 * glsl::RESIDUAL_BINS, 0);
  recorder.dispatch(passes.residuals, passes.residuals.groups(pixels),
                    {.colour_opacity = rasteriser.colour_opacity,
                     .geometry = rasteriser.geometry,
                     .sensor_colour = frame.colour,
                     .sensor_depth = frame.depth,
                     .residuals = residuals_,
                     .histograms = histograms_},
                    {.pixels = pixels, .minimum_opacity = static_cast<float>(settings.minimum_opacity)});
  record_masks(recorder, pixels, settings.outlier_factor);
  recorder.dispatch(passes.gradient, passes.gradient.groups(pixels),
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
                     .background = to_vec3(rasteriser.background)});
}

void Tracker::record_step(gpu::Recorder& recorder, const Rasteriser& rasteriser, const SensorFrame& frame,
                          const TrackingSettings& settings) {
  recorder.dispatch(step_pass_, 1,
                    {.status = rasteriser.lists.status,
                     .pose_gradient = rasteriser.pose_gradient,
                     .sums = sums,
                     .camera = camera,
                     .state = state_},
                    {.rate_rotation = static_cast<float>(settings.rate_rotation),
                     .rate_translation = static_cast<float>(settings.rate_translation),
                     .weight_colour = static_cast<float>(settings.weight_colour),
                     .weight_depth = static_cast<float>(settings.weight_depth),
                     .sensor_pixels = static_cast<float>(frame.valid_pixels)});
}

TrackingResult Tracker::track(Rasteriser& rasteriser, const GaussianMap& map, const SensorFrame& frame,
                              const Camera& start, const TrackingSettings& settings) {
  const auto begin = std::chrono::steady_clock::now();
  rasteriser.pose_gradient_kind = settings.pose_gradient;
  const glsl::CameraState first = to_device(start);
  camera.upload(std::span(&first, 1));
  const glsl::TrackState fresh{.best_camera = first, .best_loss = std::numeric_limits<float>::max()};
  state_.upload(std::span(&fresh, 1));

  gpu::Recorder recorder(device_);
  glsl::TrackState state = fresh;
  for (int done = 0; done < settings.iterations; done = static_cast<int>(state.adam.steps)) {
    for (int i = 0; i < std::min(kBatch, settings.iterations - done); ++i) {
      record_loss(recorder, rasteriser, map, frame, settings);
      rasteriser.record_backward_pose(recorder, map, {frame.size, camera, frame.depth}, Outputs::ColourDepth);
      record_step(recorder, rasteriser, frame, settings);
    }
    recorder.submit();
    const uint32_t completed = rasteriser.lists.settle();
    state = state_.download(1)[0];
    if (completed == 0) continue;  // there was too little room, and now there is enough
    const bool stuck = static_cast<int>(state.adam.steps) == done;
    if (stuck || state.last_update < settings.stop_below) break;
  }

  TrackingResult result;
  result.world_to_camera = pose_of(state.best_camera);
  result.loss = state.best_loss;
  result.valid_fraction = state.best_valid;
  result.iterations = static_cast<int>(state.adam.steps);
  result.milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace surefield
