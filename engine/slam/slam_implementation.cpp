#include "engine/slam/slam_implementation.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/slam/depth_timing.h"
#include "engine/slam/spawn.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr std::size_t kKeyframeRest = 3;  // frames between keyframes that are due to little overlap

FrameView view_of(const Frame& frame, const SlamSettings& settings) {
  return {.width = frame.colour.cols,
          .height = frame.colour.rows,
          .colour = frame.colour.ptr<uint8_t>(),
          .depth = frame.depth.ptr<float>(),
          .noise = noise_of(settings.sensor)};
}

/// With images of its own.
Frame copy_of(const Frame& frame) {
  Frame copy = frame;
  copy.colour = frame.colour.clone();
  copy.depth = frame.depth.clone();
  return copy;
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
      upkeep(engine, settings, keyframes, stop.get_token()),
      loops(engine, settings, intrinsics, keyframes) {}

void Slam::Implementation::check_usable() const {
  if (broken) throw StateError("an error has left the map half done, so no frame may follow: " + *broken);
  if (finished) throw StateError("the run is finished, so no frame may follow");
}

void Slam::Implementation::check_images(const Frame& frame) const {
  const cv::Size size(intrinsics.width, intrinsics.height);
  if (frame.colour.size() != size || frame.depth.size() != size || frame.colour.type() != CV_8UC3 ||
      frame.depth.type() != CV_32FC1 || !frame.colour.isContinuous() || !frame.depth.isContinuous())
    throw UsageError("the frame's images do not have the size and type that the intrinsics ask for");
  if (!std::isfinite(frame.depth_after)) throw UsageError("the frame's depth_after is no number of seconds");
}

Frame Slam::Implementation::within_reach(const Frame& frame) const {
  const double limit = settings.depth_max > 0 ? settings.depth_max : std::numeric_limits<float>::max();
  Frame reached = frame;
  reached.depth = cv::Mat(frame.depth.size(), CV_32FC1, cv::Scalar(0));  // not into the buffer of the caller
  float nearest = std::numeric_limits<float>::infinity(), farthest = 0;
  bool any = false;
  for (int v = 0; v < frame.depth.rows; ++v)
    for (int u = 0; u < frame.depth.cols; ++u) {
      const float z = frame.depth.at<float>(v, u);
      if (!(z > 0) || !std::isfinite(z)) continue;
      nearest = std::min(nearest, z);
      farthest = std::max(farthest, z);
      if (z > limit) continue;
      reached.depth.at<float>(v, u) = z;
      any = true;
    }
  if (history.empty() && !any && farthest > 0) {
    throw InputError(fmt::format(
        "the first frame has no depth up to depth_max, {:g} m: it was read as {:.3g} to {:.3g} m; is "
        "depth_unit, the metres for one step of the depth images, right, and is depth_max what you want?",
        settings.depth_max, nearest, farthest));
  }
  const auto motion = tracker.last_motion();
  if (frame.depth_after != 0 && motion)
    reached.depth = move_depth(reached.depth, intrinsics, depth_to_colour(frame.depth_after, *motion));
  return reached;
}

ColourGrid Slam::Implementation::look(const Frame& frame) {
  ColourGrid grid = make_colour_grid(frame);
  if (const auto objection = first_light.objection(frame, grid, !history.empty()))
    throw NoImageError(*objection);
  return grid;
}

Sighting Slam::Implementation::sight_first(const Frame& frame, ColourGrid grid, FrameReport& report) {
  scene_extent(frame);  // throws where there is none
  report.keyframe = true;
  return {{engine, view_of(frame, settings)},
          sample_points(frame, intrinsics),
          keyframes.describe(frame),
          std::move(grid),
          place_features(frame, intrinsics)};
}

Sighting Slam::Implementation::sight(const Frame& frame, ColourGrid grid, FrameReport& report) {
  const Pose predicted = tracker.predict();
  const Eigen::Vector3f as_it_is = Eigen::Vector3f::Ones(), before = history.last_report().gains;
  const auto gains_now = [&] {
    return find_gains(grid, {intrinsics, predicted}, keyframes.lit_views(), before,
                      settings.light.correct_above);
  };
  if (before != as_it_is) report.gains = gains_now();
  std::vector<Eigen::Vector3f> points = sample_points(frame, intrinsics);
  upkeep.approach(points, predicted);
  Sighting sighting{hold(frame, report.gains, predicted), std::move(points), {}, {}, {}};
  FrameFeatures features(frame, intrinsics);
  const auto approach = [&](const Pose& pose) { upkeep.approach(sighting.points, pose); };
  tracker.track(sighting.image.handle(), features, predicted, approach, report);
  // Exposures wander all the time; only a frame that cannot be tracked for it is corrected.
  const Eigen::Vector3f gains = report.lost() && before == as_it_is ? gains_now() : as_it_is;
  if (gains != as_it_is) {
    FrameReport other{.index = report.index, .timestamp = report.timestamp};
    other.gains = gains;
    HeldFrame image = hold(frame, gains, predicted);
    tracker.track(image.handle(), features, predicted, approach, other);
    if (!other.lost()) {
      report = other;
      sighting.image = std::move(image);
    }
  }
  report.keyframe = wants_keyframe(report);
  if (report.keyframe) {
    sighting.descriptor = keyframes.describe(frame);
    sighting.features = features.get();
  }
  sighting.grid = std::move(grid);
  return sighting;
}

FrameReport Slam::Implementation::locate(const Frame& frame) {
  FrameReport report{.index = frame.index, .timestamp = frame.timestamp};
  report.gains = history.last_report().gains;
  const HeldFrame image = hold(frame, report.gains, history.world_to_camera(history.size() - 1));
  const std::vector<Eigen::Vector3f> points = sample_points(frame, intrinsics);
  FrameFeatures features(frame, intrinsics);
  tracker.locate(
      image.handle(), features, [&](const Pose& pose) { upkeep.approach(points, pose); }, report);
  return report;
}

/// The frame for tracking: its images with the colours times these gains, taken from about `predicted`.
HeldFrame Slam::Implementation::hold(const Frame& frame, const Eigen::Vector3f& gains,
                                     const Pose& predicted) {
  return {engine, view_of(expose(frame, gains, predicted), settings)};
}

Frame Slam::Implementation::expose(const Frame& frame, const Eigen::Vector3f& gains, const Pose& pose) const {
  Frame exposed = frame;
  if (gains == Eigen::Vector3f::Ones()) return exposed;
  exposed.colour = apply_gains(frame.colour, gains);
  if (has_saturated(exposed.colour, gains))
    brighten_saturated(exposed.colour, engine.render({intrinsics, pose}), gains);
  return exposed;
}

bool Slam::Implementation::wants_keyframe(const FrameReport& report) const {
  if (report.state != TrackingState::Good) return false;
  if (history.size() % static_cast<std::size_t>(settings.keyframes.interval) == 0) return true;
  return tracker.sees_unmapped(report) && history.next_after_keyframe() >= kKeyframeRest;
}

void Slam::Implementation::begin_map(const Frame& frame, Sighting sighting) {
  add_keyframe(frame, std::move(sighting));
  map_first(frame);
  // Copies of the images: the caller may reuse its own.
  if (frame.depth_after != 0) first_frame = copy_of(frame);
}

void Slam::Implementation::map_first(const Frame& frame) {
  upkeep.give_time(0);  // all later frames are tracked by what the first one's mapping makes
  FrameReport& report = history.last_report();
  upkeep.begin(frame);
  const int half = settings.first_iterations / 2;
  upkeep.optimise(std::vector<int>(half, 0), {}, report);
  upkeep.densify();
  upkeep.optimise(std::vector<int>(settings.first_iterations - half, 0), {}, report);
  keyframes.set_window({0}, settings.tracking.gauss_newton.references);
  loops.begin();
}

void Slam::Implementation::extend_map(const Frame& frame, Sighting sighting) {
  const FrameReport& report = history.last_report();
  tracker.accept(report);
  if (report.found_at >= 0) keyframes.return_to(report.found_at, settings.tracking.gauss_newton.references);
  first_frame.reset();
  pending.reset();
  if (report.keyframe) {
    map_keyframe(frame, std::move(sighting));
  } else {
    pending.emplace(PendingFrame{copy_of(frame), std::move(sighting)});
  }
}

void Slam::Implementation::map_keyframe(const Frame& frame, Sighting sighting) {
  Frame mapped = add_keyframe(frame, std::move(sighting));
  FrameReport& report = history.last_report();
  hide_moved(mapped);
  brighten_dim();
  upkeep.spawn(mapped);
  const KeyframeWindow window = keyframes.choose_window(upkeep.near());
  const MappingPlan plan = upkeep.plan(window);
  upkeep.optimise(plan.first_half, plan.refined, report, 0.5);
  upkeep.judge(window.members, report);
  upkeep.densify();
  upkeep.optimise(plan.second_half, plan.refined, report);
  keyframes.set_window(window.members, settings.tracking.gauss_newton.references);
  close_loop();
  report.world_to_camera = keyframes.world_to_camera(keyframes.newest());
}

void Slam::Implementation::close_loop() {
  FrameReport& report = history.last_report();
  const auto begin = std::chrono::steady_clock::now();
  const auto back_at = loops.close(history.last_tracked_after(), report.covariance);
  report.loops_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  if (!back_at) return;
  upkeep.optimise(upkeep.plan_both(*back_at), {}, report);
}

/// Adds the last frame as a keyframe; returns it with the colours that mapping compares with, which
/// times the keyframe's gains are those of the map: its own, where the gains do not make lies of saturated
/// pixels.
Frame Slam::Implementation::add_keyframe(const Frame& frame, Sighting sighting) {
  const FrameReport& report = history.last_report();
  const Camera camera{intrinsics, report.world_to_camera};
  Keyframe keyframe = make_keyframe(frame, sighting.image.keep(), camera, std::move(sighting.points));
  keyframe.grid = std::move(sighting.grid);
  keyframe.light = report.gains;
  keyframe.features = std::move(sighting.features);
  Frame mapped = frame;
  if (report.gains != Eigen::Vector3f::Ones()) {
    if (has_saturated(apply_gains(frame.colour, report.gains), report.gains))
      mapped = expose(frame, report.gains, camera.world_to_camera);
    else
      keyframe.gains = report.gains;
    keyframe.frame = engine.load(view_of(mapped, settings));
  }
  keyframes.add(std::move(keyframe), std::move(sighting.descriptor));
  tracker.begin_keyframe();
  history.make_last_keyframe();
  return mapped;
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
