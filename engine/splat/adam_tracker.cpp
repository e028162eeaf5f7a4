#include "engine/splat/adam_tracker.h"

#include <algorithm>
#include <chrono>
#include <limits>

namespace surefield {

namespace {

// Iterations per submission: enough to hide the cost of submitting, few enough to stop in time.
constexpr int kBatch = 5;

}  // namespace

AdamTracker::AdamTracker(gpu::Device& device)
    : device_(device),
      step_pass_(device, device.limits().subgroup_size),
      camera_(device, "tracked camera"),
      state_(device, "tracking state") {}

void AdamTracker::record_step(gpu::Recorder& recorder, const Rasteriser& rasteriser, const TrackingLoss& loss,
                              const SensorFrame& frame, const TrackingSettings& settings) {
  recorder.dispatch(step_pass_, 1,
                    {.status = rasteriser.lists.status,
                     .pose_gradient = rasteriser.pose_gradient,
                     .sums = loss.sums,
                     .histograms = loss.histograms,
                     .camera = camera_,
                     .state = state_},
                    {.rate_rotation = static_cast<float>(settings.adam.rate_rotation),
                     .rate_translation = static_cast<float>(settings.adam.rate_translation),
                     .weight_colour = static_cast<float>(settings.weight_colour),
                     .weight_depth = static_cast<float>(settings.weight_depth),
                     .sensor_pixels = static_cast<float>(frame.valid_pixels)});
}

TrackingResult AdamTracker::track(Rasteriser& rasteriser, TrackingLoss& loss, const GaussianMap& map,
                                  const SensorFrame& frame, const Camera& start,
                                  const TrackingSettings& settings) {
  const auto begin = std::chrono::steady_clock::now();
  const glsl::CameraState first = to_device(start);
  camera_.upload(std::span(&first, 1));
  const glsl::TrackState fresh{.best_camera = first, .best_loss = std::numeric_limits<float>::max()};
  state_.upload(std::span(&fresh, 1));

  gpu::Recorder recorder(device_);
  glsl::TrackState state = fresh;
  const View view = tracking_view(frame, camera_, settings);
  const auto record = [&](std::size_t) {
    loss.record(recorder, rasteriser, map, view, frame, settings);
    loss.record_gradient(recorder, rasteriser, view, frame, settings);
    rasteriser.record_backward_pose(recorder, map, view, settings.adam.pose_gradient, Outputs::ColourDepth);
    record_step(recorder, rasteriser, loss, frame, settings);
  };
  for (int done = 0; done < settings.adam.iterations; done = static_cast<int>(state.adam.steps)) {
    rasteriser.lists.submit(recorder, std::min(kBatch, settings.adam.iterations - done), record);
    state = state_.download(1)[0];
    const bool stuck = static_cast<int>(state.adam.steps) == done;
    if (stuck || state.last_update < settings.adam.stop_below) break;
  }

  TrackingResult result;
  result.world_to_camera = pose_of(state.best_camera);
  result.loss = state.best_loss;
  result.valid_fraction = state.best_valid;
  result.explained = state.best_explained;
  result.seen_through = state.best_through;
  result.iterations = static_cast<int>(state.adam.steps);
  result.milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace surefield
