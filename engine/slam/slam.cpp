#include "engine/slam/slam.h"

#include <algorithm>
#include <deque>
#include <map>
#include <numeric>
#include <optional>
#include <random>
#include <stdexcept>

#include "engine/slam/active_region.h"
#include "engine/slam/covisibility.h"
#include "engine/slam/exposure.h"
#include "engine/slam/keyframes.h"
#include "engine/slam/spawn.h"

namespace surefield {

namespace {

constexpr int kKeyframeRest = 3;           // frames between keyframes that are due to little overlap
constexpr std::size_t kRecentLosses = 10;  // frames whose tracking loss is the measure of a jump

FrameView view_of(const Frame& frame, double depth_max) {
  return {.width = frame.colour.cols,
          .height = frame.colour.rows,
          .colour = frame.colour.ptr<uint8_t>(),
          .depth = frame.depth.ptr<float>(),
          .depth_max = static_cast<float>(depth_max)};
}

/// A frame's pose relative to the keyframe that it was tracked after, so that it follows that keyframe's
/// refinement.
struct TrackedFrame {
  double timestamp = 0;
  int keyframe = 0;
  Pose keyframe_to_frame = Pose::Identity();
};

}  // namespace

struct Slam::Implementation {
  SlamSettings settings;
  Intrinsics intrinsics;
  Covisibility covisibility;
  SplatEngine engine;
  ActiveRegion region;
  std::mt19937 random;
  double extent = 1;
  std::vector<Keyframe> keyframes;
  std::vector<TrackedFrame> frames;
  std::vector<FrameReport> reports;
  std::deque<double> recent_losses;
  std::vector<int> window;                              ///< keyframes that were optimised together last
  std::vector<int> reference_keyframes;                 ///< whose images frames are aligned to beside the map
  std::optional<std::pair<Frame, FrameHandle>> newest;  ///< the last frame fed, unless it is a keyframe
  int last_keyframe_frame = 0;                          ///< position among the frames fed
  double valid_after_keyframe = 1;                      ///< valid_fraction of the frame just after it

  Implementation(const SlamSettings& s, const Intrinsics& k, const EngineOptions& options)
      : settings(s),
        intrinsics(k),
        covisibility(s.keyframes),
        engine(options),
        region(engine, s),
        random(static_cast<uint32_t>(s.seed)) {
    engine.set_depth_model(s.depth_model);
  }

  Pose world_to_frame(std::size_t i) const {
    const TrackedFrame& f = frames[i];
    return f.keyframe_to_frame * keyframes[f.keyframe].camera.world_to_camera;
  }

  /// Constant velocity: the last pose moved on by the last motion.
  Pose predict() const {
    const std::size_t n = frames.size();
    if (n < 2) return world_to_frame(n - 1);
    return world_to_frame(n - 1) * world_to_frame(n - 2).inverse() * world_to_frame(n - 1);
  }

  /// The keyframes whose images the next frame is aligned to beside the map.
  std::vector<TrackingReference> references() const {
    std::vector<TrackingReference> references;
    for (int k : reference_keyframes) references.push_back({keyframes[k].frame, keyframes[k].camera});
    return references;
  }

  void check_size(const Frame& frame) const {
    const cv::Size size(intrinsics.width, intrinsics.height);
    if (frame.colour.size() != size || frame.depth.size() != size || frame.colour.type() != CV_8UC3 ||
        frame.depth.type() != CV_32FC1 || !frame.colour.isContinuous() || !frame.depth.isContinuous())
      throw std::invalid_argument(
          "the frame's images do not have the size and type that the intrinsics ask for");
  }

  void initialise(const Frame& frame, FrameReport& report);
  void track(FrameHandle handle, FrameReport& report);
  bool wants_keyframe(const FrameReport& report) const;
  void map_newest(FrameReport& report);
  void measure(FrameReport& report) const;
  void release_newest();
  bool looks_lost(const TrackingResult& result) const;
  TrackingResult retry(FrameHandle handle, const TrackingSettings& tracking, TrackingResult best,
                       FrameReport& report);
  void add_keyframe(const Frame& frame, FrameHandle handle, const Pose& world_to_camera);
  void map_window(FrameReport& report);
  void align_to(std::vector<int> members);
  void optimise(const std::vector<int>& order, const std::vector<int>& refined, FrameReport& report);
  void judge(const std::vector<int>& members, FrameReport& report);
  void densify();
};

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
  engine.assign(spawn_gaussians(frame, camera, nullptr, settings.spawn, settings.depth_max));
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

bool Slam::Implementation::looks_lost(const TrackingResult& result) const {
  if (result.valid_fraction < settings.lost.minimum_valid) return true;
  if (recent_losses.empty()) return false;
  const double mean = std::accumulate(recent_losses.begin(), recent_losses.end(), 0.0) /
                      static_cast<double>(recent_losses.size());
  return result.loss > settings.lost.loss_jump * mean;
}

/// Other starting poses: no motion since the last frame, and the last keyframe's pose.
TrackingResult Slam::Implementation::retry(FrameHandle handle, const TrackingSettings& tracking,
                                           TrackingResult best, FrameReport& report) {
  TrackingSettings patient = tracking;
  patient.iterations *= 2;
  patient.renders *= 2;
  for (const Pose& start : {world_to_frame(frames.size() - 1), keyframes.back().camera.world_to_camera}) {
    if (!looks_lost(best)) break;
    const TrackingResult other = engine.track(handle, {intrinsics, start}, patient, references());
    ++report.retries;
    report.tracking_iterations += other.iterations;
    report.tracking_ms += other.milliseconds;
    const bool enough = std::min(best.valid_fraction, other.valid_fraction) >= settings.lost.minimum_valid;
    const bool better = enough ? other.loss < best.loss : other.valid_fraction > best.valid_fraction;
    if (better || !looks_lost(other)) best = other;
  }
  return best;
}

void Slam::Implementation::track(FrameHandle handle, FrameReport& report) {
  TrackingSettings tracking = settings.tracking;
  if (frames.size() == 1)
    tracking.iterations = std::max(tracking.iterations, settings.first_tracking_iterations);
  TrackingResult result = engine.track(handle, {intrinsics, predict()}, tracking, references());
  report.tracking_iterations = result.iterations;
  report.tracking_ms = result.milliseconds;
  if (looks_lost(result)) result = retry(handle, tracking, result, report);
  report.lost = looks_lost(result);
  report.world_to_camera = result.world_to_camera;
  report.tracking_loss = result.loss;
  report.valid_fraction = result.valid_fraction;
  if (!report.lost) {
    if (static_cast<int>(frames.size()) == last_keyframe_frame + 1)
      valid_after_keyframe = result.valid_fraction;
    recent_losses.push_back(result.loss);
    if (recent_losses.size() > kRecentLosses) recent_losses.pop_front();
  }
  const int reference = static_cast<int>(keyframes.size()) - 1;
  frames.push_back({report.timestamp, reference,
                    result.world_to_camera * keyframes[reference].camera.world_to_camera.inverse()});
}

void Slam::Implementation::add_keyframe(const Frame& frame, FrameHandle handle, const Pose& world_to_camera) {
  const Camera camera{intrinsics, world_to_camera};
  covisibility.add(frame);
  keyframes.push_back(
      make_keyframe(frame, handle, camera, sample_points(frame, intrinsics, settings.depth_max)));
  frames.back() = {frame.timestamp, static_cast<int>(keyframes.size()) - 1, Pose::Identity()};
  last_keyframe_frame = static_cast<int>(frames.size()) - 1;
  const RenderImages rendered = engine.render(camera);
  Eigen::Vector3f& gains = keyframes.back().gains;
  gains = keyframes[keyframes.size() - 2].gains;
  if (settings.keyframes.exposure) gains = fit_gains(frame, rendered, settings.depth_max).value_or(gains);
  const GaussianCloud births =
      spawn_gaussians(frame, camera, &rendered, settings.spawn, settings.depth_max, gains);
  region.settle(keyframes, covisibility.similar(), static_cast<uint32_t>(births.size()));
  engine.insert(births);
}

void Slam::Implementation::map_window(FrameReport& report) {
  const KeyframeWindow chosen = covisibility.window(keyframes, region.near());
  const auto order = mapping_order(chosen, region.near(), settings.mapping_iterations,
                                   settings.keyframes.past_keyframes, random);
  std::vector<int> refined;
  const bool refines = settings.mapping.rate_pose_rotation > 0 || settings.mapping.rate_pose_translation > 0;
  for (int member : chosen.members)
    if (refines && member != chosen.fixed) refined.push_back(member);
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(order.size() / 2);
  optimise({order.begin(), middle}, refined, report);
  judge(chosen.members, report);
  densify();
  optimise({middle, order.end()}, refined, report);
  report.world_to_camera = keyframes.back().camera.world_to_camera;
  align_to(chosen.members);
  window = chosen.members;
}

/// Takes keyframes of the window, the newest first, as what frames are aligned to beside the map.
void Slam::Implementation::align_to(std::vector<int> members) {
  std::reverse(members.begin(), members.end());
  members.resize(std::min<std::size_t>(members.size(), std::max(settings.tracking.references, 0)));
  reference_keyframes = std::move(members);
}

void Slam::Implementation::optimise(const std::vector<int>& order, const std::vector<int>& refined,
                                    FrameReport& report) {
  std::vector<MappingView> views;
  std::map<int, int> view_of_keyframe;
  std::vector<int> steps;
  for (int keyframe : order) {
    const auto [entry, is_new] = view_of_keyframe.try_emplace(keyframe, static_cast<int>(views.size()));
    if (is_new)
      views.push_back({keyframes[keyframe].frame, keyframes[keyframe].camera,
                       std::find(refined.begin(), refined.end(), keyframe) != refined.end(),
                       keyframes[keyframe].gains});
    steps.push_back(entry->second);
  }
  const MappingResult result = engine.optimise(views, steps, settings.mapping, extent);
  for (const auto& [keyframe, view] : view_of_keyframe) keyframes[keyframe].camera = views[view].camera;
  report.mapping_iterations += result.iterations;
  report.mapping_ms += result.milliseconds;
}

/// Takes the opacity from Gaussians that are uncertain over the window's keyframes.
void Slam::Implementation::judge(const std::vector<int>& members, FrameReport& report) {
  std::vector<MappingView> views;
  for (int member : members) views.push_back({keyframes[member].frame, keyframes[member].camera, false});
  const JudgeResult result = engine.judge(views, settings.mapping);
  report.uncertain_gaussians = result.uncertain;
  report.mapping_ms += result.milliseconds;
}

void Slam::Implementation::densify() {
  DensifySettings densify = settings.densify;
  densify.extent = extent;
  densify.seed = random();
  engine.densify(densify);
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
