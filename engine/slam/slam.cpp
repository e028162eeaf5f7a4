#include "engine/slam/slam.h"

#include <mutex>
#include <utility>

#include "engine/slam/slam_implementation.h"
#include "engine/slam/slam_turn.h"

namespace surefield {

Slam::Slam(const SlamSettings& settings, const Intrinsics& intrinsics, const EngineOptions& options,
           std::unique_ptr<ImageDescriptor> descriptor)
    : implementation_(
          std::make_unique<Implementation>(settings, intrinsics, options, std::move(descriptor))) {}

Slam::~Slam() = default;

FrameReport Slam::feed(const Frame& taken, const Tracked& tracked) {
  Implementation& s = *implementation_;
  Turn turn(s);
  s.check_usable();
  s.check_images(taken);
  s.upkeep.give_time(s.settings.budget_ms);
  Frame frame = s.within_reach(taken);
  const bool first = s.history.empty();
  ColourGrid grid = s.look(frame);
  FrameReport found{.index = frame.index, .timestamp = frame.timestamp};
  Sighting sighting =
      first ? s.sight_first(frame, std::move(grid), found) : s.sight(frame, std::move(grid), found);
  if (s.shows_depth_moved(found)) {
    // The map was made of depth that is not where its colours are; the second frame is tracked in the better
    // one.
    s.change_map(false, [&] { s.begin_again(found); });
    frame = s.within_reach(taken);
    found = {.index = frame.index, .timestamp = frame.timestamp};
    sighting = s.sight(frame, make_colour_grid(frame), found);
  }
  s.history.add(found);
  turn.tell_tracked(tracked);
  if (found.state == TrackingState::Good) s.engine.keep_render();

  s.change_map(false, [&] {
    if (first)
      s.begin_map(frame, std::move(sighting));
    else
      s.extend_map(frame, std::move(sighting));
    s.measure();
  });
  const FrameReport report = s.history.last_report();
  turn.tell_revision();
  return report;
}

FrameReport Slam::locate(const Frame& taken) {
  Implementation& s = *implementation_;
  const Turn turn(s);
  if (s.broken)
    throw StateError("an error has left the map half done, so nothing is found in it: " + *s.broken);
  if (s.history.empty()) throw StateError("there is no map yet to find a frame in; feed one first");
  s.check_images(taken);
  Frame frame = taken;
  frame.depth_after = 0;  // nobody knows how a camera moves that may be anywhere
  return s.locate(s.within_reach(frame));
}

void Slam::finish() {
  Implementation& s = *implementation_;
  Turn turn(s);
  if (s.finished) return;
  s.check_usable();
  s.upkeep.give_time(0);
  if (s.pending && s.history.last_report().state == TrackingState::Good) {
    s.pending->sighting.descriptor = s.keyframes.describe(s.pending->frame);
    s.pending->sighting.features = place_features(s.pending->frame, s.intrinsics);
    s.change_map(true, [&] {
      s.map_keyframe(s.pending->frame, std::move(s.pending->sighting));
      s.measure();
    });
  }
  s.pending.reset();
  s.settle_exposure();
  s.finished = true;
  turn.tell_revision();
}

void Slam::stop_mapping() {
  implementation_->stop.request_stop();
}

bool Slam::usable() const {
  const std::lock_guard lock(implementation_->state);
  return !implementation_->broken && !implementation_->finished;
}

void Slam::change(const SlamSettings& settings) {
  const Turn turn(*implementation_);
  SlamSettings& current = implementation_->settings;
  current.tracking = settings.tracking;
  current.mapping = settings.mapping;
  current.spawn = settings.spawn;
  current.densify = settings.densify;
  current.lost = settings.lost;
  current.light = settings.light;
  current.mapping_iterations = settings.mapping_iterations;
  current.budget_ms = settings.budget_ms;
  current.keyframes.interval = settings.keyframes.interval;
  current.keyframes.valid_below = settings.keyframes.valid_below;
}

Trajectory Slam::trajectory() const {
  const std::lock_guard lock(implementation_->state);
  return implementation_->history.trajectory();
}

Trajectory Slam::online_trajectory() const {
  const std::lock_guard lock(implementation_->state);
  Trajectory trajectory;
  for (const FrameReport& report : implementation_->history.reports())
    trajectory.push_back({report.timestamp, report.world_to_camera.inverse(), report.lost()});
  return trajectory;
}

std::vector<Loop> Slam::loops() const {
  const std::lock_guard lock(implementation_->state);
  return implementation_->loops.loops();
}

Trajectory Slam::keyframes() const {
  const std::lock_guard lock(implementation_->state);
  Trajectory trajectory;
  for (const Keyframe& keyframe : implementation_->keyframes.all())
    trajectory.push_back({keyframe.timestamp, keyframe.camera.world_to_camera.inverse()});
  return trajectory;
}

std::vector<int> Slam::window() const {
  const std::lock_guard lock(implementation_->state);
  return implementation_->keyframes.window();
}

GaussianCloud Slam::map() const {
  const std::lock_guard lock(implementation_->state);
  GaussianCloud cloud = implementation_->engine.map();
  scale_colours(cloud, implementation_->map_gains);
  return cloud;
}

RenderImages Slam::render(const Camera& camera) const {
  const std::lock_guard lock(implementation_->state);
  RenderImages images = implementation_->engine.render_whole(camera);
  scale_colours(images, implementation_->map_gains);
  return images;
}

uint64_t Slam::revision() const {
  const std::lock_guard lock(implementation_->state);
  return implementation_->revision;
}

void Slam::on_revision(RevisionListener listener) {
  const Turn turn(*implementation_);
  implementation_->listener = std::move(listener);
}

std::vector<FrameReport> Slam::reports() const {
  const std::lock_guard lock(implementation_->state);
  return implementation_->history.reports();
}

EngineReport Slam::engine_report() const {
  const std::lock_guard lock(implementation_->state);
  return implementation_->engine.report();
}

}  // namespace surefield
