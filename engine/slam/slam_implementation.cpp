#include "engine/slam/slam_implementation.h"

#include <utility>

#include "engine/slam/spawn.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr std::size_t kKeyframeRest = 3;  // frames between keyframes that are due to little overlap

FrameView view_of(const Frame& frame, double depth_max) {
  return {.width = frame.colour.cols,
          .height = frame.colour.rows,
          .colour = frame.colour.ptr<uint8_t>(),
          .depth = frame.depth.ptr<float>(),
          .depth_max = static_cast<float>(depth_max)};
}

}  // namespace

Slam::Implementation::Implementation(const SlamSettings& s, const Intrinsics& k, const EngineOptions& options,
                                     std::unique_ptr<ImageDescriptor> descriptor)
    : settings(s),
      intrinsics(k),
      keyframes(s.keyframes, std::move(descriptor)),
      engine(options),
      history(keyframes),
      tracker(engine, settings, intrinsics, keyframes, history),
      upkeep(engine, settings, keyframes) {}

void Slam::Implementation::check_usable() const {
  if (broken) throw StateError("an error has left the map half done, so no frame may follow: " + *broken);
  if (finished) throw StateError("the run is finished, so no frame may follow");
}

void Slam::Implementation::check_images(const Frame& frame) const {
  const cv::Size size(intrinsics.width, intrinsics.height);
  if (frame.colour.size() != size || frame.depth.size() != size || frame.colour.type() != CV_8UC3 ||
      frame.depth.type() != CV_32FC1 || !frame.colour.isContinuous() || !frame.depth.isContinuous())
    throw UsageError("the frame's images do not have the size and type that the intrinsics ask for");
}

Sighting Slam::Implementation::sight_first(const Frame& frame, FrameReport& report) {
  scene_extent(frame, settings.depth_max);  // throws where there is none
  report.keyframe = true;
  return {{engine, view_of(frame, settings.depth_max)},
          sample_points(frame, intrinsics, settings.depth_max),
          keyframes.describe(frame)};
}

Sighting Slam::Implementation::sight(const Frame& frame, FrameReport& report) {
  Sighting sighting{
      {engine, view_of(frame, settings.depth_max)}, sample_points(frame, intrinsics, settings.depth_max), {}};
  const Pose predicted = tracker.predict();
  upkeep.approach(sighting.points, predicted);
  tracker.track(sighting.image.handle(), predicted, report);
  report.keyframe = wants_keyframe(report);
  if (report.keyframe) sighting.descriptor = keyframes.describe(frame);
  return sighting;
}

bool Slam::Implementation::wants_keyframe(const FrameReport& report) const {
  if (report.lost) return false;
  if (history.size() % static_cast<std::size_t>(settings.keyframes.interval) == 0) return true;
  return tracker.sees_unmapped(report) && history.next_after_keyframe() >= kKeyframeRest;
}

void Slam::Implementation::begin_map(const Frame& frame, Sighting sighting) {
  add_keyframe(frame, std::move(sighting));
  FrameReport& report = history.last_report();
  upkeep.begin(frame);
  const int half = settings.first_iterations / 2;
  upkeep.optimise(std::vector<int>(half, 0), {}, report);
  upkeep.densify();
  upkeep.optimise(std::vector<int>(settings.first_iterations - half, 0), {}, report);
  keyframes.set_window({0}, settings.tracking.gauss_newton.references);
}

void Slam::Implementation::extend_map(const Frame& frame, Sighting sighting) {
  const FrameReport& report = history.last_report();
  tracker.accept(report);
  pending.reset();
  if (report.keyframe) {
    map_keyframe(frame, std::move(sighting));
  } else {
    // Copies of the images: the caller may reuse its own.
    pending.emplace(PendingFrame{{frame.index, frame.timestamp, frame.colour.clone(), frame.depth.clone()},
                                 std::move(sighting)});
  }
}

void Slam::Implementation::map_keyframe(const Frame& frame, Sighting sighting) {
  add_keyframe(frame, std::move(sighting));
  FrameReport& report = history.last_report();
  upkeep.spawn(frame);
  const KeyframeWindow window = keyframes.choose_window(upkeep.near());
  const MappingPlan plan = upkeep.plan(window);
  upkeep.optimise(plan.first_half, plan.refined, report);
  upkeep.judge(window.members, report);
  upkeep.densify();
  upkeep.optimise(plan.second_half, plan.refined, report);
  report.world_to_camera = keyframes.world_to_camera(keyframes.newest());
  keyframes.set_window(window.members, settings.tracking.gauss_newton.references);
}

void Slam::Implementation::add_keyframe(const Frame& frame, Sighting sighting) {
  const Camera camera{intrinsics, history.last_report().world_to_camera};
  keyframes.add(make_keyframe(frame, sighting.image.keep(), camera, std::move(sighting.points)),
                std::move(sighting.descriptor));
  history.make_last_keyframe();
  tracker.begin_keyframe();
}

/// Notes the size of the map after a frame.
void Slam::Implementation::measure() {
  FrameReport& report = history.last_report();
  report.gaussians = engine.size();
  report.device_gaussians = engine.device_size();
  report.device_bytes = engine.device_bytes();
}

/// The exception that is being handled has ended mapping in the middle.
void Slam::Implementation::note_break() {
  broken = "an unknown error";
  try {
    throw;
  } catch (const std::exception& error) {
    broken = error.what();
  } catch (...) {
  }
}

/// Counts a revision where keyframes have moved, the newest one only if its pose was told.
void Slam::Implementation::note_moves(bool told) {
  bool moved = false;
  for (int k : keyframes.take_moved()) moved = moved || told || k != keyframes.newest();
  if (moved) ++revision;
}

}  // namespace surefield
