#include "engine/splat/engine.h"

#include <algorithm>
#include <chrono>

#include "engine/splat/adam_tracker.h"
#include "engine/splat/densifier.h"
#include "engine/splat/frame_store.h"
#include "engine/splat/gauss_newton_tracker.h"
#include "engine/splat/map_blocks.h"
#include "engine/splat/mapper.h"
#include "engine/splat/uncertainty.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

// Mapping steps per submission: a driver may end a submission that runs for seconds.
constexpr std::size_t kMappingBatch = 5;
// Views whose lists are kept between their steps: as many as a cycle of the mapping order has by default.
constexpr std::size_t kKeptLists = 6;
static_assert(kMappingBatch < FrameStore::kPlaces, "a submission's frames are on the device together");

double milliseconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

struct SplatEngine::Implementation {
  gpu::Device device;
  GaussianMap map;
  Rasteriser rasteriser;
  TrackingLoss tracking_loss;
  AdamTracker adam_tracker;
  GaussNewtonTracker gauss_newton_tracker;
  Mapper mapper;
  UncertaintyJudge judge;
  Densifier densifier;
  FrameStore frames;
  MapBlocks blocks;
  AnchorMover anchor_mover;
  std::vector<CameraVariable> cameras;  ///< of the views of a call, used again and again
  std::vector<ViewLists> kept_lists;    ///< of some of these views, while others are at hand

  explicit Implementation(const EngineOptions& options)
      : device({.selector = options.device, .validate = options.validate}),
        map(device),
        rasteriser(device),
        tracking_loss(device),
        adam_tracker(device),
        gauss_newton_tracker(device),
        mapper(device),
        judge(device),
        densifier(device),
        frames(device),
        blocks(device),
        anchor_mover(device) {
    device.finish_pipelines();
  }

  /// The map, to be changed.
  GaussianMap& change_map() {
    gauss_newton_tracker.forget_render();
    return map;
  }

  /// Has a keyframe in a place of the tracker, for frames with intrinsics `k`.
  void hold(std::size_t place, const TrackingReference& reference, const Intrinsics& k) {
    const Intrinsics& own = reference.camera.intrinsics;
    if (own.width != k.width || own.height != k.height)
      throw UsageError("a keyframe to align a frame to is not of the frame's size");
    if (!gauss_newton_tracker.holds(place, reference.frame))
      gauss_newton_tracker.hold(place, reference.frame, frames.on_device(reference.frame), own);
  }

  /// The views' cameras on the device.
  std::span<CameraVariable> cameras_of(std::span<const MappingView> views) {
    while (cameras.size() < views.size()) cameras.emplace_back(device, Camera{});
    for (std::size_t v = 0; v < views.size(); ++v) cameras[v].assign(views[v].camera, views[v].gains);
    return std::span(cameras).first(views.size());
  }

  /// Brings the lists that view `v` left behind to hand, if there are any. `at_hand`: whose place is empty.
  void take_out_lists(std::size_t v, std::size_t& at_hand) {
    const std::size_t place = v % kKeptLists;
    if (place == at_hand) return;
    rasteriser.lists.exchange(kept_lists[at_hand]);
    rasteriser.lists.exchange(kept_lists[place]);
    at_hand = place;
  }

  /// Takes the steps of `order`, a few per submission.
  /// Returns how many steps were done.
  std::size_t run_steps(std::span<const MappingView> views, std::span<CameraVariable> view_cameras,
                        std::span<const int> order, const MappingSettings& settings, double pixel,
                        const MappingLimit& limit) {
    GaussianMap& changed = change_map();
    rasteriser.lists.forget();
    while (kept_lists.size() < kKeptLists) kept_lists.emplace_back(device);
    std::size_t at_hand = 0;
    gpu::Recorder recorder(device);
    // Where time is short it is looked at after each step.
    const std::size_t most = limit.until ? 1 : kMappingBatch;
    for (std::size_t begin = 0; begin < order.size(); begin += most) {
      if (limit.reached(begin)) return begin;
      const auto batch = order.subspan(begin, std::min(most, order.size() - begin));
      rasteriser.lists.submit(recorder, batch.size(), [&](std::size_t step) {
        const MappingView& view = views[batch[step]];
        CameraVariable& camera = view_cameras[batch[step]];
        take_out_lists(batch[step], at_hand);
        mapper.record_step(recorder, rasteriser, changed,
                           {.frame = frames.on_device(view.frame),
                            .camera = camera,
                            .refine_pose = view.refine_pose,
                            .same_lists = rasteriser.lists.serve(camera.camera)},
                           settings, pixel);
      });
    }
    return order.size();
  }
};

SplatEngine::SplatEngine(const EngineOptions& options)
    : implementation_(std::make_unique<Implementation>(options)) {}

SplatEngine::~SplatEngine() = default;

FrameHandle SplatEngine::load(const FrameView& frame) {
  return implementation_->frames.load(frame);
}

void SplatEngine::release(FrameHandle frame) {
  implementation_->frames.release(frame);
}

void SplatEngine::hide(FrameHandle frame, std::span<const uint8_t> pixels) {
  implementation_->frames.hide(frame, pixels);
  implementation_->gauss_newton_tracker.drop(frame);
}

void SplatEngine::assign(const GaussianCloud& cloud, DepthModel depth_model) {
  implementation_->change_map().assign(cloud, depth_model);
  implementation_->blocks.clear();
}

void SplatEngine::insert(const GaussianCloud& cloud) {
  implementation_->change_map().append(cloud);
}

GaussianCloud SplatEngine::map() const {
  GaussianCloud cloud = implementation_->map.download();
  implementation_->blocks.append_to(cloud, implementation_->map);
  return cloud;
}

uint32_t SplatEngine::size() const {
  return implementation_->map.size() + implementation_->blocks.parked();
}

uint32_t SplatEngine::device_size() const {
  return implementation_->map.size();
}

void SplatEngine::set_map_budget(uint64_t bytes) {
  implementation_->blocks.set_budget(bytes);
}

bool SplatEngine::is_whole(uint32_t births) const {
  return implementation_->blocks.is_whole(implementation_->map, births);
}

bool SplatEngine::recall(const WorldPoints& points) {
  Implementation& i = *implementation_;
  const uint32_t before = i.map.size();
  const bool whole = i.blocks.recall(i.map, points);
  if (i.map.size() != before) i.change_map();
  return whole;
}

int SplatEngine::focus(std::span<const WorldPoints> regions, uint32_t births) {
  return implementation_->blocks.focus(implementation_->change_map(), regions, births);
}

void SplatEngine::move(std::span<const Pose> motions) {
  Implementation& i = *implementation_;
  const std::vector<glsl::AnchorMotion> moved = to_device(motions);
  i.anchor_mover.move(i.change_map(), moved);
  i.blocks.move(i.map, moved);
}

RenderImages SplatEngine::render(const Camera& camera) const {
  return render(camera, std::span<const float>{});
}

RenderImages SplatEngine::render(const Camera& camera, std::span<const float> sensor_depth) const {
  return implementation_->rasteriser.render(implementation_->map, camera, sensor_depth);
}

RenderImages SplatEngine::render_whole(const Camera& camera) const {
  if (implementation_->blocks.parked() == 0) return render(camera);
  GaussianMap whole(implementation_->device);
  whole.assign(map(), implementation_->map.depth_model());
  return implementation_->rasteriser.render(whole, camera);
}

TrackingResult SplatEngine::track(FrameHandle frame, const Camera& start, const TrackingSettings& settings,
                                  std::span<const TrackingReference> references) {
  Implementation& i = *implementation_;
  if (settings.method == TrackingMethod::Adam)
    return i.adam_tracker.track(i.rasteriser, i.tracking_loss, i.map, i.frames.on_device(frame), start,
                                settings);
  std::vector<Camera> cameras;
  for (const TrackingReference& reference :
       references.first(std::min(references.size(), GaussNewtonTracker::kReferences))) {
    i.hold(cameras.size(), reference, start.intrinsics);
    cameras.push_back(reference.camera);
  }
  return i.gauss_newton_tracker.track(i.rasteriser, i.tracking_loss, i.map, i.frames.on_device(frame), start,
                                      settings, cameras);
}

PairAlignment SplatEngine::align(FrameHandle frame, const Camera& start, const TrackingReference& reference,
                                 const TrackingSettings& settings) {
  Implementation& i = *implementation_;
  i.hold(0, reference, start.intrinsics);
  return i.gauss_newton_tracker.align(i.rasteriser, i.frames.on_device(frame), start, reference.camera,
                                      settings);
}

void SplatEngine::keep_render() {
  implementation_->gauss_newton_tracker.keep_render();
}

MappingResult SplatEngine::optimise(std::span<MappingView> views, std::span<const int> order,
                                    const MappingSettings& settings, double pixel,
                                    const MappingLimit& limit) {
  const auto begin = std::chrono::steady_clock::now();
  Implementation& i = *implementation_;
  const std::span<CameraVariable> cameras = i.cameras_of(views);
  const std::size_t done = i.run_steps(views, cameras, order, settings, pixel, limit);
  for (std::size_t v = 0; v < views.size(); ++v)
    if (views[v].refine_pose) views[v].camera.world_to_camera = pose_of(cameras[v].camera.download(1)[0]);

  MappingResult result;
  result.iterations = static_cast<int>(done);
  if (done > 0) result.loss = i.mapper.read_loss(i.frames.on_device(views[order[done - 1]].frame), settings);
  result.milliseconds = milliseconds_since(begin);
  return result;
}

JudgeResult SplatEngine::judge(std::span<const MappingView> views, const MappingSettings& settings) {
  if (!(settings.uncertainty_above > 0)) return {};
  const auto begin = std::chrono::steady_clock::now();
  Implementation& i = *implementation_;
  gpu::Recorder recorder(i.device);
  i.judge.record_begin(recorder, i.map);
  const std::span<CameraVariable> cameras = i.cameras_of(views);
  for (std::size_t v = 0; v < views.size(); ++v) {
    i.rasteriser.lists.submit(recorder, 1, [&](std::size_t) {
      i.judge.record_view(recorder, i.rasteriser, i.map, i.frames.on_device(views[v].frame),
                          cameras[v].camera, settings);
    });
  }
  i.judge.record_verdict(recorder, i.change_map(), settings);
  recorder.submit();
  return {.uncertain = i.judge.read_uncertain(), .milliseconds = milliseconds_since(begin)};
}

DensifyResult SplatEngine::densify(const DensifySettings& settings) {
  return implementation_->densifier.densify(implementation_->change_map(), settings);
}

EngineReport SplatEngine::report() const {
  const gpu::Device& device = implementation_->device;
  return {.device = device.report().name,
          .driver = device.report().driver,
          .is_cpu = device.limits().is_cpu,
          .map_bytes = size() * implementation_->map.parameter_bytes(),
          .device_peak_bytes = device.memory_peak(),
          .device_use = device.counters(),
          .validation_messages = device.validation_messages()};
}

uint64_t SplatEngine::device_bytes() const {
  return implementation_->device.memory_in_use();
}

}  // namespace surefield
