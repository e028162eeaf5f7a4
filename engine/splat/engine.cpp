#include "engine/splat/engine.h"

#include <chrono>
#include <stdexcept>
#include <unordered_map>

#include "engine/splat/adam_tracker.h"
#include "engine/splat/densifier.h"
#include "engine/splat/gauss_newton_tracker.h"
#include "engine/splat/mapper.h"

namespace surefield {

namespace {

// Mapping steps per submission: a driver may end a submission that runs for seconds.
constexpr std::size_t kMappingBatch = 5;

}  // namespace

struct SplatEngine::Implementation {
  gpu::Device device;
  GaussianMap map;
  Rasteriser rasteriser;
  TrackingLoss tracking_loss;
  AdamTracker adam_tracker;
  GaussNewtonTracker gauss_newton_tracker;
  Mapper mapper;
  Densifier densifier;
  std::unordered_map<FrameHandle, SensorFrame> frames;
  FrameHandle next_frame = 0;

  explicit Implementation(const EngineOptions& options)
      : device({.selector = options.device, .validate = options.validate}),
        map(device),
        rasteriser(device),
        tracking_loss(device),
        adam_tracker(device),
        gauss_newton_tracker(device),
        mapper(device),
        densifier(device) {}

  /// Takes the steps of `order`, a few per submission; steps from the first on that found too little room are
  /// taken again.
  void run_steps(std::span<const MappingView> views, std::span<CameraVariable> cameras,
                 std::span<const int> order, const MappingSettings& settings, double extent) {
    gpu::Recorder recorder(device);
    for (std::size_t done = 0; done < order.size();) {
      const std::size_t end = std::min(order.size(), done + kMappingBatch);
      for (std::size_t i = done; i < end; ++i) {
        const MappingView& view = views[order[i]];
        mapper.record_step(recorder, rasteriser, map, frames.at(view.frame), cameras[order[i]],
                           view.refine_pose, settings, extent);
      }
      recorder.submit();
      done += rasteriser.lists.settle();
    }
  }
};

SplatEngine::SplatEngine(const EngineOptions& options)
    : implementation_(std::make_unique<Implementation>(options)) {}

SplatEngine::~SplatEngine() = default;

FrameHandle SplatEngine::load(const FrameView& frame) {
  const FrameHandle handle = implementation_->next_frame++;
  implementation_->frames.emplace(handle, SensorFrame(implementation_->device, frame));
  return handle;
}

void SplatEngine::release(FrameHandle frame) {
  implementation_->frames.erase(frame);
}

void SplatEngine::assign(const GaussianCloud& cloud) {
  implementation_->map.assign(cloud);
}

void SplatEngine::insert(const GaussianCloud& cloud) {
  implementation_->map.append(cloud);
}

GaussianCloud SplatEngine::map() const {
  return implementation_->map.download();
}

uint32_t SplatEngine::size() const {
  return implementation_->map.size();
}

RenderImages SplatEngine::render(const Camera& camera) const {
  return render(camera, std::span<const float>{});
}

RenderImages SplatEngine::render(const Camera& camera, std::span<const float> sensor_depth) const {
  return implementation_->rasteriser.render(implementation_->map, camera, sensor_depth);
}

TrackingResult SplatEngine::track(FrameHandle frame, const Camera& start, const TrackingSettings& settings) {
  Implementation& i = *implementation_;
  const auto track_with = [&](auto& tracker) {
    return tracker.track(i.rasteriser, i.tracking_loss, i.map, i.frames.at(frame), start, settings);
  };
  return settings.method == TrackingMethod::Adam ? track_with(i.adam_tracker)
                                                 : track_with(i.gauss_newton_tracker);
}

MappingResult SplatEngine::optimise(std::span<MappingView> views, std::span<const int> order,
                                    const MappingSettings& settings, double extent) {
  const auto begin = std::chrono::steady_clock::now();
  Implementation& i = *implementation_;
  std::vector<CameraVariable> cameras;
  for (const MappingView& view : views) cameras.emplace_back(i.device, view.camera);
  i.run_steps(views, cameras, order, settings, extent);
  for (std::size_t v = 0; v < views.size(); ++v)
    if (views[v].refine_pose) views[v].camera.world_to_camera = pose_of(cameras[v].camera.download(1)[0]);

  MappingResult result;
  result.iterations = static_cast<int>(order.size());
  if (!order.empty()) result.loss = i.mapper.read_loss(i.frames.at(views[order.back()].frame), settings);
  result.milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

DensifyResult SplatEngine::densify(const DensifySettings& settings) {
  return implementation_->densifier.densify(implementation_->map, settings);
}

EngineReport SplatEngine::report() const {
  const gpu::Device& device = implementation_->device;
  return {.device = device.report().name,
          .driver = device.report().driver,
          .map_bytes = implementation_->map.parameter_bytes(),
          .device_peak_bytes = device.memory_peak(),
          .validation_messages = device.validation_messages()};
}

uint64_t SplatEngine::device_bytes() const {
  return implementation_->device.memory_in_use();
}

}  // namespace surefield
