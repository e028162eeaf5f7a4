#include "engine/splat/gauss_newton_tracker.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "engine/splat/pose_evidence.h"

namespace surefield {

namespace {

// Steps of each level, finest first: after the first render all levels, later the finest alone.
constexpr int kFirstSteps[] = {4, 4, 6};
constexpr int kLaterSteps = 4;
// Of the finest levels every ninth and every third pixel take part: as many of each, and no less accurate
// than more of them (docs/experiments.md).
constexpr uint32_t kStrides[] = {9, 3, 1};
// And of those every so many tell how certain the pose is.
constexpr uint32_t kEvidenceStride = 14;
// Fewer pixels than this are not thinned out to.
constexpr uint64_t kLeastSamples = 1000;
// It counts as that of so many pixels, however fine the images: what errs together does not become smaller.
constexpr double kEvidencePixels = 6400;
// Parts of the evidence: each source as a whole, and its photometric term alone.
constexpr std::size_t kParts = 2 * glsl::ALIGN_SOURCES;
// Tracking ends when an alignment has moved the camera by less, radians and metres.
constexpr double kStill = 3e-4;
// A frame is aligned to the render that was kept where the camera is expected to have moved by less since,
// radians and metres.
constexpr double kNear = 0.1;
// Where a keyframe has no depth, metres: half an inverse metre, give or take as much, is anything from a
// metre to infinity.
constexpr float kUnmeasured = 2;
// Where the scales of the residuals start: intensity (0 to 1), and distance in standard deviations of depth.
constexpr glsl::AlignScales kFirstScales{.colour = 0.1f * 0.1f, .depth = 10 * 10};

static_assert(sizeof(glsl::AlignSums) == glsl::ALIGN_VALUES * sizeof(float));

/// `stride`, or what leaves enough pixels of a small image.
uint32_t stride_of(uint32_t stride, const ImageSize& size) {
  return static_cast<uint32_t>(std::clamp<uint64_t>(size.pixels() / kLeastSamples, 1, stride));
}

/// Whether there is anything to interpolate between.
bool can_interpolate(const ImageSize& size) {
  return size.width >= 2 && size.height >= 2;
}

/// How far the last alignment has moved the camera: radians (to first order) or metres, the larger.
double motion_of(const glsl::AlignState& state) {
  const glsl::vec3 &t = state.translation, &x = state.rotation0, &y = state.rotation1, &z = state.rotation2;
  const Eigen::Vector3d turn(z.y - y.z, x.z - z.x, y.x - x.y);
  return std::max(turn.norm() / 2, Eigen::Vector3d(t.x, t.y, t.z).norm());
}

/// Before the first step: the camera that was rendered is where the alignment starts.
glsl::AlignState first_state(const Camera& start, std::span<const Camera> references) {
  const glsl::CameraState first = to_device(start);
  glsl::AlignState state{.base = first,
                         .rotation0 = {1, 0, 0},
                         .rotation1 = {0, 1, 0},
                         .rotation2 = {0, 0, 1},
                         .best_camera = first,
                         .best_loss = std::numeric_limits<float>::max()};
  for (glsl::AlignScales& scales : state.scales) scales = kFirstScales;
  for (std::size_t i = 0; i < references.size(); ++i) state.references[i] = to_device(references[i]);
  return state;
}

/// `rendered` is the camera that was rendered, and the alignment starts at `start`.
void set_base(glsl::AlignState& state, const Camera& rendered, const Camera& start) {
  const Pose motion = start.world_to_camera * rendered.world_to_camera.inverse();
  const glsl::CameraState moved = to_device(Camera{start.intrinsics, motion});
  state.base = to_device(rendered);
  state.rotation0 = moved.rotation0;
  state.rotation1 = moved.rotation1;
  state.rotation2 = moved.rotation2;
  state.translation = moved.translation;
}

template <std::size_t Count>
std::array<gpu::Array<glsl::AlignPoint>, Count> make_arrays(gpu::Device& device) {
  const auto make = [&](auto) { return gpu::Array<glsl::AlignPoint>(device, "keyframe points"); };
  return [&]<std::size_t... I>(std::index_sequence<I...>) {
    return std::array{make(I)...};
  }
  (std::make_index_sequence<Count>());
}

}  // namespace

GaussNewtonTracker::Level::Level(gpu::Device& device)
    : sensor(device, "sensor level"),
      rendered(device, "rendered level"),
      points(device, "rendered points"),
      kept_points(device, "kept points"),
      reference_points(make_arrays<kReferences>(device)) {}

GaussNewtonTracker::GaussNewtonTracker(gpu::Device& device)
    : device_(device),
      subgroups_(gpu::kWorkgroup / device.limits().subgroup_size),
      sensor_pass_(device, gpu::kWorkgroup),
      rendered_alpha_(device, gpu::kWorkgroup, {.NORMALISED_DEPTH = 0}),
      rendered_normalised_(device, gpu::kWorkgroup, {.NORMALISED_DEPTH = 1}),
      halve_pass_(device, gpu::kWorkgroup),
      points_pass_(device, gpu::kWorkgroup),
      sums_pass_(device, gpu::kWorkgroup, {.FROM_KEYFRAME = 0}),
      keyframe_sums_pass_(device, gpu::kWorkgroup, {.FROM_KEYFRAME = 1}),
      crossed_sums_pass_(device, gpu::kWorkgroup, {.CROSSED = 1}),
      crossed_keyframe_sums_pass_(device, gpu::kWorkgroup, {.FROM_KEYFRAME = 1, .CROSSED = 1}),
      begin_pass_(device, device.limits().subgroup_size),
      step_pass_(device, gpu::kWorkgroup),
      evidence_pass_(device, gpu::kWorkgroup),
      camera_(device, "tracked camera"),
      state_(device, "alignment state"),
      partial_sums_(device, "partial alignment sums"),
      evidence_(device, "evidence of the pose", kParts),
      levels_{Level(device), Level(device), Level(device)} {}

void GaussNewtonTracker::resize(gpu::Recorder& recorder, const ImageSize& size) {
  const ImageSize& before = levels_[0].size;
  if (before.width != size.width || before.height != size.height) held_ = {};
  ImageSize now = size;
  for (Level& level : levels_) {
    level.size = now;
    recorder.reserve(level.sensor, now.pixels());
    recorder.reserve(level.rendered, now.pixels());
    recorder.reserve(level.points, now.pixels());
    recorder.reserve(level.kept_points, now.pixels());
    now = {now.width / 2, now.height / 2};
  }
  recorder.reserve(partial_sums_,
                   kParts * subgroups_ * (size.pixels() / (gpu::kWorkgroup * glsl::ALIGN_STRIP) + 1));
}

void GaussNewtonTracker::record_halves(gpu::Recorder& recorder, gpu::Array<glsl::vec2> Level::*image) {
  for (int i = 1; i < kLevels; ++i) {
    const ImageSize& size = levels_[i].size;
    recorder.dispatch(
        halve_pass_, halve_pass_.groups(size.pixels()),
        {.source = levels_[i - 1].*image, .image = levels_[i].*image},
        {.width = size.width, .height = size.height, .source_width = levels_[i - 1].size.width});
  }
}

void GaussNewtonTracker::record_sensor(gpu::Recorder& recorder, const SensorFrame& frame) {
  const auto pixels = static_cast<uint32_t>(frame.size.pixels());
  recorder.dispatch(sensor_pass_, sensor_pass_.groups(pixels),
                    {.sensor_colour = frame.colour, .sensor_depth = frame.depth, .image = levels_[0].sensor},
                    {.pixels = pixels});
  record_halves(recorder, &Level::sensor);
}

void GaussNewtonTracker::record_points(gpu::Recorder& recorder, const Rasteriser& rasteriser,
                                       const TrackingSettings& settings) {
  const auto pixels = static_cast<uint32_t>(levels_[0].size.pixels());
  const auto& pass = settings.depth == DepthKind::Normalised ? rendered_normalised_ : rendered_alpha_;
  recorder.dispatch(pass, pass.groups(pixels),
                    {.colour_opacity = rasteriser.colour_opacity,
                     .geometry = rasteriser.geometry,
                     .image = levels_[0].rendered},
                    {.pixels = pixels, .minimum_opacity = static_cast<float>(settings.minimum_opacity)});
  record_halves(recorder, &Level::rendered);
  for (uint32_t i = 0; i < kLevels; ++i) record_level(recorder, i, levels_[i].rendered, levels_[i].points, 0);
}

void GaussNewtonTracker::record_level(gpu::Recorder& recorder, uint32_t index,
                                      const gpu::Array<glsl::vec2>& image,
                                      const gpu::Array<glsl::AlignPoint>& points, float unknown) {
  const ImageSize& size = levels_[index].size;
  recorder.dispatch(points_pass_, points_pass_.groups(size.pixels()),
                    {.camera = camera_, .image = image, .points = points},
                    {.width = size.width, .height = size.height, .level = index, .unknown = unknown});
}

void GaussNewtonTracker::hold(std::size_t place, FrameHandle handle, const SensorFrame& frame,
                              const Intrinsics& intrinsics) {
  const glsl::CameraState camera = to_device(Camera{intrinsics});
  camera_.upload(std::span(&camera, 1));
  gpu::Recorder recorder(device_);
  resize(recorder, frame.size);
  record_sensor(recorder, frame);
  for (uint32_t i = 0; i < kLevels; ++i) {
    recorder.reserve(levels_[i].reference_points[place], levels_[i].size.pixels());
    record_level(recorder, i, levels_[i].sensor, levels_[i].reference_points[place], kUnmeasured);
  }
  recorder.submit();
  held_[place] = handle;
}

void GaussNewtonTracker::keep_render() {
  if (!last_render_) return;
  for (Level& level : levels_) level.points.exchange_memory(level.kept_points);
  kept_render_ = std::exchange(last_render_, std::nullopt);
}

void GaussNewtonTracker::forget_render() {
  last_render_.reset();
  kept_render_.reset();
}

void GaussNewtonTracker::drop(FrameHandle frame) {
  for (auto& held : held_)
    if (held == frame) held.reset();
}

void GaussNewtonTracker::record_begin(gpu::Recorder& recorder, const Rasteriser& rasteriser,
                                      const TrackingLoss& loss, const SensorFrame& frame,
                                      const TrackingSettings& settings) {
  recorder.dispatch(begin_pass_, 1,
                    {.status = rasteriser.lists.status,
                     .camera = camera_,
                     .sums = loss.sums,
                     .histograms = loss.histograms,
                     .state = state_},
                    {.weight_colour = static_cast<float>(settings.weight_colour),
                     .weight_depth = static_cast<float>(settings.weight_depth),
                     .sensor_pixels = static_cast<float>(frame.valid_pixels)});
}

/// Records the sums of one source over a level; they land as the `part`-th run of partial sums. Returns how
/// many these are.
uint32_t GaussNewtonTracker::record_sums(gpu::Recorder& recorder, const SensorFrame& frame, const SumsOf& of,
                                         const TrackingSettings& settings) {
  const Level& level = levels_[of.level];
  const bool render = of.source == 0;
  const uint64_t samples = (level.size.pixels() + of.stride - 1) / of.stride;
  const auto strips = static_cast<uint32_t>((samples + glsl::ALIGN_STRIP - 1) / glsl::ALIGN_STRIP);
  const uint32_t groups = sums_pass_.groups(strips), count = groups * subgroups_;
  const GaussNewtonSettings& weights = settings.gauss_newton;
  const auto& step = render ? sums_pass_ : keyframe_sums_pass_;
  const auto& crossed = render ? crossed_sums_pass_ : crossed_keyframe_sums_pass_;
  recorder.dispatch(of.crossed ? crossed : step, groups,
                    {.state = state_,
                     .points = !render   ? level.reference_points[of.source - 1]
                               : of.kept ? level.kept_points
                                         : level.points,
                     .sensor = level.sensor,
                     .partial_sums = partial_sums_},
                    {.width = level.size.width,
                     .height = level.size.height,
                     .level = static_cast<uint32_t>(of.level),
                     .strips = strips,
                     .stride = of.stride,
                     .weight = render ? 1.0f : static_cast<float>(weights.reference_weight),
                     .balance = of.photometric ? 0.0f : static_cast<float>(weights.balance),
                     .source = of.source,
                     .first = of.part * count,
                     .noise = frame.noise});
  return count;
}

void GaussNewtonTracker::record_step(gpu::Recorder& recorder, const Rasteriser& rasteriser,
                                     const SensorFrame& frame, int level, bool kept, const Sources& sources,
                                     const TrackingSettings& settings) {
  if (!can_interpolate(levels_[level].size)) return;
  const uint32_t stride = stride_of(kStrides[level], levels_[level].size);
  uint32_t count = 0;
  for (uint32_t part = 0; part < sources.count; ++part)
    count = record_sums(
        recorder, frame,
        {.level = level, .stride = stride, .source = sources.first + part, .part = part, .kept = kept},
        settings);
  recorder.dispatch(step_pass_, 1,
                    {.status = rasteriser.lists.status,
                     .partial_sums = gpu::as_words(partial_sums_),
                     .state = state_,
                     .camera = camera_},
                    {.count = count, .first_source = sources.first, .sources = sources.count});
}

/// Records what each source, and its photometric term alone, says of the pose at hand.
void GaussNewtonTracker::record_evidence(gpu::Recorder& recorder, const SensorFrame& frame,
                                         const Sources& sources, const TrackingSettings& settings) {
  if (!can_interpolate(levels_[0].size)) return;
  const uint32_t parts = 2 * sources.count;
  uint32_t count = 0;
  for (uint32_t part = 0; part < parts; ++part)
    count = record_sums(recorder, frame,
                        {.level = 0,
                         .stride = stride_of(kEvidenceStride, frame.size),
                         .source = sources.first + part / 2,
                         .part = part,
                         .photometric = part % 2 == 1,
                         .crossed = true},
                        settings);
  recorder.dispatch(evidence_pass_, 1,
                    {.partial_sums = gpu::as_words(partial_sums_), .evidence = gpu::as_words(evidence_)},
                    {.count = count, .parts = parts});
}

/// Records the alignment of the frame: on all levels, or to a later render on the finest alone.
void GaussNewtonTracker::record_alignment(gpu::Recorder& recorder, const Rasteriser& rasteriser,
                                          const SensorFrame& frame, Target target, const Sources& sources,
                                          const TrackingSettings& settings) {
  if (target == Target::Later) {
    for (int i = 0; i < kLaterSteps; ++i)
      record_step(recorder, rasteriser, frame, 0, false, sources, settings);
    return;
  }
  for (int level = kLevels - 1; level >= 0; --level)
    for (int i = 0; i < kFirstSteps[level]; ++i)
      record_step(recorder, rasteriser, frame, level, target == Target::Kept, sources, settings);
}

/// Whether there is a render that was kept to which a frame that is expected at `start` can be aligned.
bool GaussNewtonTracker::kept_render_serves(const Camera& start, const TrackingSettings& settings) const {
  if (!kept_render_) return false;
  const Intrinsics &now = start.intrinsics, &then = kept_render_->camera.intrinsics;
  const bool alike = now.width == then.width && now.height == then.height && now.fx == then.fx &&
                     now.fy == then.fy && now.cx == then.cx && now.cy == then.cy &&
                     settings.depth == kept_render_->depth &&
                     settings.minimum_opacity == kept_render_->minimum_opacity &&
                     settings.uncertainty_above == kept_render_->uncertainty_above;
  const Pose motion = start.world_to_camera * kept_render_->camera.world_to_camera.inverse();
  return alike && motion.translation().norm() < kNear && Eigen::AngleAxisd(motion.rotation()).angle() < kNear;
}

PoseEvidence GaussNewtonTracker::read_evidence(const SensorFrame& frame, const Sources& sources) const {
  if (!can_interpolate(frame.size)) return {};
  return evidence_of(evidence_.download(2 * sources.count), kEvidencePixels *
                                                                stride_of(kEvidenceStride, frame.size) /
                                                                static_cast<double>(frame.size.pixels()));
}

PairAlignment GaussNewtonTracker::align(Rasteriser& rasteriser, const SensorFrame& frame, const Camera& start,
                                        const Camera& reference, const TrackingSettings& settings) {
  const glsl::AlignState state = first_state(start, std::span(&reference, 1));
  const glsl::CameraState first = to_device(start);
  const Sources sources{1, 1};
  camera_.upload(std::span(&first, 1));
  state_.upload(std::span(&state, 1));
  gpu::Recorder recorder(device_);
  resize(recorder, frame.size);
  record_sensor(recorder, frame);
  record_alignment(recorder, rasteriser, frame, Target::First, sources, settings);
  record_evidence(recorder, frame, sources, settings);
  recorder.submit();
  return {pose_of(camera_.download(1)[0]), read_evidence(frame, sources)};
}

TrackingResult GaussNewtonTracker::track(Rasteriser& rasteriser, TrackingLoss& loss, const GaussianMap& map,
                                         const SensorFrame& frame, const Camera& start,
                                         const TrackingSettings& settings,
                                         std::span<const Camera> references) {
  const auto begin = std::chrono::steady_clock::now();
  glsl::AlignState state = first_state(start, references);
  const glsl::CameraState first = to_device(start);
  camera_.upload(std::span(&first, 1));
  gpu::Recorder recorder(device_);
  resize(recorder, frame.size);
  record_sensor(recorder, frame);
  const Sources sources{0, 1 + static_cast<uint32_t>(references.size())};
  const bool serves = kept_render_serves(start, settings);
  if (serves) set_base(state, kept_render_->camera, start);
  state_.upload(std::span(&state, 1));
  TrackingResult result;
  if (serves) {
    record_alignment(recorder, rasteriser, frame, Target::Kept, sources, settings);
    recorder.submit();
    state = state_.download(1)[0];
    ++result.iterations;
  }
  const View view = tracking_view(frame, camera_, settings);
  for (bool last = false; !last;) {
    const bool is_first = result.iterations == 0;
    last = result.iterations >= settings.gauss_newton.renders || (!is_first && motion_of(state) < kStill);
    rasteriser.lists.submit(recorder, 1, [&](std::size_t) {
      loss.record(recorder, rasteriser, map, view, frame, settings);
      record_begin(recorder, rasteriser, loss, frame, settings);
      record_points(recorder, rasteriser, settings);
      if (last)
        record_evidence(recorder, frame, sources, settings);
      else
        record_alignment(recorder, rasteriser, frame, is_first ? Target::First : Target::Later, sources,
                         settings);
    });
    state = state_.download(1)[0];
    if (!last) ++result.iterations;
  }
  last_render_ = {{start.intrinsics, pose_of(state.base)},
                  settings.minimum_opacity,
                  settings.uncertainty_above,
                  settings.depth};

  result.world_to_camera = pose_of(state.best_camera);
  result.loss = state.best_loss;
  result.valid_fraction = state.best_valid;
  result.explained = state.best_explained;
  result.seen_through = state.best_through;
  result.evidence = read_evidence(frame, sources);
  result.milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace surefield
