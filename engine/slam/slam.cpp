#include "engine/slam/slam.h"

#include "engine/slam/slam_implementation.h"
#include "engine/slam/spawn.h"

namespace surefield {

namespace {

constexpr int kKeyframeRest = 3;  // frames between keyframes that are due to little overlap

FrameView view_of(const Frame& frame, double depth_max) {
  return {.width = frame.colour.cols,
          .height = frame.colour.rows,
          .colour = frame.colour.ptr<uint8_t>(),
          .depth = frame.depth.ptr<float>(),
          .depth_max = static_cast<float>(depth_max)};
}

}  // namespace

Slam::Slam(const SlamSettings& settings, const Intrinsics& intrinsics, const EngineOptions& options)
    : implementation_(std::make_unique<Implementation>(settings, intrinsics, options)) {}

Slam::~Slam() = default;

const FrameReport& Slam::feed(const Frame& frame) {
  Implementation& s = *implementation_;
  s.check_size(frame);
  FrameReport report{.index = frame.index, .timestamp = frame.timestamp};
  if (s.frames.empty()) {
    s.initialise(frame, report);
  } else {
    const FrameHandle handle = s.engine.load(view_of(frame, s.settings.depth_max));
    s.release_newest();
    s.region.approach(s.keyframes, sample_points(frame, s.intrinsics, s.settings.depth_max), s.predict());
    s.track(handle, report);
    report.keyframe = s.wants_keyframe(report);
    // Copies of the images: the caller may reuse its own.
    s.newest = {Frame{frame.index, frame.timestamp, frame.colour.clone(), frame.depth.clone()}, handle};
    if (report.keyframe) s.map_newest(report);
  }
  s.measure(report);
  s.reports.push_back(report);
  return s.reports.back();
}

void Slam::finish() {
  Implementation& s = *implementation_;
  if (s.newest && !s.reports.back().lost) s.map_newest(s.reports.back());
  s.release_newest();
  if (!s.reports.empty()) s.measure(s.reports.back());
}

bool Slam::Implementation::wants_keyframe(const FrameReport& report) const {
  if (report.lost) return false;
  const int frame = static_cast<int>(frames.size()) - 1;
  if (frame % settings.keyframes.interval == 0) return true;
  return report.valid_fraction < settings.keyframes.valid_below * valid_after_keyframe &&
         frame - last_keyframe_frame >= kKeyframeRest;
}

/// Makes the newest frame a keyframe and optimises the map over its window.
void Slam::Implementation::map_newest(FrameReport& report) {
  add_keyframe(newest->first, newest->second, report.world_to_camera);
  newest.reset();
  map_window(report);
  report.keyframe = true;
}

/// Notes the size of the map after a frame.
void Slam::Implementation::measure(FrameReport& report) const {
  report.gaussians = engine.size();
  report.device_gaussians = engine.device_size();
  report.device_bytes = engine.device_bytes();
}

void Slam::Implementation::release_newest() {
  if (newest) engine.release(newest->second);
  newest.reset();
}

void Slam::Implementation::initialise(const Frame& frame, FrameReport& report) {
  extent = scene_extent(frame, settings.depth_max);
  const Camera camera{intrinsics};
  engine.assign(spawn_gaussians(frame, camera, nullptr, settings.spawn, settings.depth_max),
                settings.depth_model);
  covisibility.add(frame);
  frames.push_back({frame.timestamp, 0, Pose::Identity()});
  keyframes.push_back(make_keyframe(frame, engine.load(view_of(frame, settings.depth_max)), camera,
                                    sample_points(frame, intrinsics, settings.depth_max)));
  const int half = settings.first_iterations / 2;
  optimise(std::vector<int>(half, 0), {}, report);
  densify();
  optimise(std::vector<int>(settings.first_iterations - half, 0), {}, report);
  align_to({0});
  window = {0};
  report.keyframe = true;
}

void Slam::change(const SlamSettings& settings) {
  SlamSettings& current = implementation_->settings;
  current.tracking = settings.tracking;
  current.mapping = settings.mapping;
  current.spawn = settings.spawn;
  current.densify = settings.densify;
  current.lost = settings.lost;
  current.mapping_iterations = settings.mapping_iterations;
  current.keyframes.interval = settings.keyframes.interval;
  current.keyframes.valid_below = settings.keyframes.valid_below;
}

const std::vector<int>& Slam::window() const {
  return implementation_->window;
}

Trajectory Slam::trajectory() const {
  Trajectory trajectory;
  for (std::size_t i = 0; i < implementation_->frames.size(); ++i)
    trajectory.push_back(
        {implementation_->frames[i].timestamp, implementation_->world_to_frame(i).inverse()});
  return trajectory;
}

Trajectory Slam::keyframes() const {
  Trajectory trajectory;
  for (const Keyframe& keyframe : implementation_->keyframes)
    trajectory.push_back({keyframe.timestamp, keyframe.camera.world_to_camera.inverse()});
  return trajectory;
}

GaussianCloud Slam::map() const {
  return implementation_->engine.map();
}

RenderImages Slam::render(const Camera& camera) const {
  return implementation_->engine.render_whole(camera);
}

const std::vector<FrameReport>& Slam::reports() const {
  return implementation_->reports;
}

EngineReport Slam::engine_report() const {
  return implementation_->engine.report();
}

}  // namespace surefield
