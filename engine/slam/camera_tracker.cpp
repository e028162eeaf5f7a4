#include "engine/slam/camera_tracker.h"

#include <algorithm>
#include <numbers>

namespace surefield {

namespace {

constexpr std::size_t kRecent = 10;  // good frames that a frame is compared with

// From when on a pose is not to be trusted (docs/method.md, "Knowing when it is wrong").
constexpr double kPoorPosition = 0.02;                    // standard deviation, metres
constexpr double kPoorRotation = std::numbers::pi / 180;  // radians
// What the map explains of the depth that is compared, and of all depth, over what it did of late.
constexpr double kPoorShare = 0.65, kLostShare = 0.5;
constexpr double kPoorExplained = 0.5, kLostExplained = 0.4;
constexpr double kPoorThrough = 0.1;  // of all depth, what may see through the map beyond what did of late
// A poor pose farther from the last known one than this is none.
constexpr double kPoorMove = 0.3;                          // metres
constexpr double kPoorTurn = 20 * std::numbers::pi / 180;  // radians
// What a map explains that no frame has been tracked in yet.
constexpr TrackingFit kFirstFit{.loss = 0, .share = 0.5, .explained = 0.5, .seen_through = 0.25};

constexpr int kFewestInliers = 15;  // features that a pose is told by
constexpr int kMatched = 10;        // keyframes that a frame's features are compared with, the newest ones
// Of all keyframes, those that look most like a frame that is lost, and from how many of them it is tracked.
constexpr int kPlaces = 10;
constexpr std::size_t kTriedPlaces = 3;
constexpr int kFewestThere = 6;  // features that tell where to begin: the map judges the pose then

TrackingSettings made_patient(TrackingSettings tracking) {
  tracking.adam.iterations *= 2;
  tracking.gauss_newton.renders *= 2;
  return tracking;
}

bool is_certain(const PoseCovariance& covariance) {
  return position_sigma(covariance) < kPoorPosition && rotation_sigma(covariance) < kPoorRotation;
}

}  // namespace

/// Constant velocity: the last pose moved on by the last motion. After a lost frame, the last pose that was
/// known.
Pose CameraTracker::predict() const {
  const std::size_t n = history_.size();
  if (n < 2) return history_.world_to_camera(n - 1);
  const Pose last = history_.world_to_camera(n - 1);
  const auto motion = last_motion();
  return motion ? motion->motion * last : last;
}

std::optional<CameraMotion> CameraTracker::last_motion() const {
  const std::size_t n = history_.size();
  if (n == 1) return expected_;
  if (n < 2 || history_.report(n - 1).lost() || history_.report(n - 2).lost()) return std::nullopt;
  return CameraMotion{history_.world_to_camera(n - 1) * history_.world_to_camera(n - 2).inverse(),
                      history_.report(n - 1).timestamp - history_.report(n - 2).timestamp};
}

/// By how much constant velocity was wrong about the last frame; nothing where that cannot be told.
std::optional<PredictionError> CameraTracker::last_error() const {
  const std::size_t n = history_.size();
  if (n < 3) return std::nullopt;
  for (std::size_t i = n - 3; i < n; ++i)
    if (history_.report(i).state != TrackingState::Good) return std::nullopt;
  const Pose last = history_.world_to_camera(n - 2);
  const Pose predicted = last * history_.world_to_camera(n - 3).inverse() * last;
  const Pose off = history_.world_to_camera(n - 1) * predicted.inverse();
  return PredictionError{off.translation().norm(), Eigen::AngleAxisd(off.rotation()).angle()};
}

/// Aligns a frame from `start`, in the world of the newest keyframe.
TrackingResult CameraTracker::align_to_newest(FrameHandle image, const Pose& start,
                                              const TrackingSettings& tracking) const {
  if (drift_.none()) return engine_.track(image, {intrinsics_, start}, tracking, keyframes_.references());
  std::vector<TrackingReference> references = keyframes_.references();
  for (std::size_t i = 0; i < references.size(); ++i) {
    Pose& pose = references[i].camera.world_to_camera;
    pose = drift_.seen_from_newest(pose, keyframes_.newest() - keyframes_.reference_keyframes()[i]);
  }
  const auto frames = static_cast<double>(history_.next_after_keyframe());
  const Camera in_newest{intrinsics_, drift_.drifted(start, -frames)};
  TrackingResult result = engine_.track(image, in_newest, tracking, references);
  result.world_to_camera = drift_.drifted(result.world_to_camera, frames);
  return result;
}

/// Aligns a frame from `start`. What it leaves open is as predicted: without that, the noise of the images
/// holds the camera where it was.
TrackingResult CameraTracker::align(FrameHandle image, const Pose& start,
                                    const TrackingSettings& tracking) const {
  TrackingResult result = align_to_newest(image, start, tracking);
  if (last_motion() && !is_certain(covariance_of(result.evidence)))
    result.world_to_camera = fuse(predict(), usual_fit().error, result.world_to_camera, result.evidence);
  return result;
}

void CameraTracker::track(FrameHandle image, FrameFeatures& features, const Pose& start,
                          const Approach& approach, FrameReport& report) const {
  TrackingSettings tracking = settings_.tracking;
  if (history_.size() == 1)
    tracking.adam.iterations = std::max(tracking.adam.iterations, tracking.adam.first_iterations);
  TrackingResult result = align(image, start, tracking);
  report.tracking_iterations = result.iterations;
  report.tracking_ms = result.milliseconds;
  if (state_of(result) != TrackingState::Good) {
    const TrackingSettings patient = made_patient(tracking);
    result = retry(image, features, patient, result, report);
    if (state_of(result) == TrackingState::Lost)
      result = find_again(image, features, patient, approach, result, report);
  }
  tell(result, report);
}

void CameraTracker::locate(FrameHandle image, FrameFeatures& features, const Approach& approach,
                           FrameReport& report) const {
  tell(find_again(image, features, made_patient(settings_.tracking), approach, {}, report), report);
}

/// Judges what was found. The pose of a lost frame is the last one that was known.
void CameraTracker::tell(const TrackingResult& result, FrameReport& report) const {
  report.state = state_of(result);
  report.world_to_camera =
      report.lost() ? history_.world_to_camera(history_.size() - 1) : result.world_to_camera;
  report.tracking_loss = result.loss;
  report.valid_fraction = result.valid_fraction;
  report.explained = result.explained;
  report.seen_through = result.seen_through;
  report.covariance = covariance_of(result.evidence);
}

/// Other starting poses: the one that features tell, no motion since the last frame, and the last keyframe's.
TrackingResult CameraTracker::retry(FrameHandle image, FrameFeatures& features,
                                    const TrackingSettings& tracking, TrackingResult best,
                                    FrameReport& report) const {
  std::vector<Pose> starts;
  if (const auto pose = pose_by_features(features)) starts.push_back(*pose);
  starts.push_back(history_.world_to_camera(history_.size() - 1));
  starts.push_back(keyframes_.world_to_camera(keyframes_.newest()));
  for (const Pose& start : starts) {
    if (state_of(best) == TrackingState::Good) break;
    const TrackingResult other = align(image, start, tracking);
    ++report.retries;
    report.tracking_iterations += other.iterations;
    report.tracking_ms += other.milliseconds;
    if (is_better(other, best)) best = other;
  }
  return best;
}

/// In the whole map: at the keyframes that look most like the frame, of which features tell its pose.
TrackingResult CameraTracker::find_again(FrameHandle image, FrameFeatures& features,
                                         const TrackingSettings& tracking, const Approach& approach,
                                         TrackingResult best, FrameReport& report) const {
  struct Place {
    int keyframe, inliers;
    Pose pose;
  };
  std::vector<Place> places;
  const PlacedFeatures& own = features.get();
  for (int k : best_apart(keyframes_.places().similarities(to_floats(own.descriptors)), kPlaces, 0, 0)) {
    const auto match = match_rigidly(keyframes_[k].features, own, noise_of(settings_.sensor), kFewestThere);
    if (match) places.push_back({k, match->inliers, match->from_to * keyframes_.world_to_camera(k)});
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& a, const Place& b) { return a.inliers > b.inliers; });
  if (places.size() > kTriedPlaces) places.resize(kTriedPlaces);
  for (const Place& place : places) {
    approach(place.pose);
    const TrackingResult other =
        engine_.track(image, {intrinsics_, place.pose}, tracking, keyframes_.references_at(place.keyframe));
    ++report.retries;
    report.tracking_iterations += other.iterations;
    report.tracking_ms += other.milliseconds;
    if (state_of(other) != TrackingState::Good) continue;
    report.found_at = place.keyframe;
    return other;
  }
  return best;
}

/// By the keyframe of the last ones that most of the frame's features agree with.
std::optional<Pose> CameraTracker::pose_by_features(FrameFeatures& features) const {
  std::optional<Pose> pose;
  int most = 0;
  for (int k = keyframes_.newest(); k >= 0 && k > keyframes_.newest() - kMatched; --k) {
    const auto match = match_rigidly(keyframes_[k].features, features.get(), noise_of(settings_.sensor),
                                     std::max(kFewestInliers, most + 1));
    if (!match) continue;
    most = match->inliers;
    pose = match->from_to * keyframes_.world_to_camera(k);
  }
  return pose;
}

TrackingFit CameraTracker::usual_fit() const {
  if (recent_.empty()) return kFirstFit;
  TrackingFit mean;
  const auto count = static_cast<double>(recent_.size());
  for (const TrackingFit& fit : recent_) {
    mean.loss += fit.loss / count;
    mean.share += fit.share / count;
    mean.explained += fit.explained / count;
    mean.seen_through += fit.seen_through / count;
    mean.error.position += fit.error.position / count;
    mean.error.rotation += fit.error.rotation / count;
  }
  return mean;
}

TrackingState CameraTracker::state_of(const TrackingResult& result) const {
  if (result.valid_fraction < settings_.lost.minimum_valid) return TrackingState::Lost;
  const TrackingFit usual = usual_fit();
  if (usual.loss > 0 && result.loss > settings_.lost.loss_jump * usual.loss) return TrackingState::Lost;
  const double share = result.explained / result.valid_fraction;
  if (share < kLostShare * usual.share || result.explained < kLostExplained * usual.explained)
    return TrackingState::Lost;
  const bool explained = share > kPoorShare * usual.share &&
                         result.explained > kPoorExplained * usual.explained &&
                         result.seen_through < usual.seen_through + kPoorThrough;
  if (explained && is_certain(covariance_of(result.evidence))) return TrackingState::Good;
  return is_near_last(result.world_to_camera) ? TrackingState::Poor : TrackingState::Lost;
}

/// Whether the camera can have come from where it was last known to be.
bool CameraTracker::is_near_last(const Pose& world_to_camera) const {
  const Pose motion = world_to_camera * history_.world_to_camera(history_.size() - 1).inverse();
  const Pose back = motion.inverse();  // its translation is the way of the camera's centre
  return back.translation().norm() < kPoorMove && Eigen::AngleAxisd(motion.rotation()).angle() < kPoorTurn;
}

bool CameraTracker::is_better(const TrackingResult& result, const TrackingResult& other) const {
  const TrackingState state = state_of(result), others = state_of(other);
  if (state != others) return state < others;
  const bool enough = std::min(result.valid_fraction, other.valid_fraction) >= settings_.lost.minimum_valid;
  return enough ? result.loss < other.loss : result.valid_fraction > other.valid_fraction;
}

bool CameraTracker::sees_unmapped(const FrameReport& report) const {
  const double after_keyframe = valid_after_keyframe_ == 0 ? report.valid_fraction : valid_after_keyframe_;
  return report.valid_fraction < settings_.keyframes.valid_below * after_keyframe;
}

void CameraTracker::accept(const FrameReport& report) {
  if (report.state != TrackingState::Good) return;
  if (valid_after_keyframe_ == 0) valid_after_keyframe_ = report.valid_fraction;
  recent_.push_back({report.tracking_loss, report.explained / report.valid_fraction, report.explained,
                     report.seen_through, last_error().value_or(usual_fit().error)});
  if (recent_.size() > kRecent) recent_.pop_front();
}

void CameraTracker::begin_keyframe() {
  valid_after_keyframe_ = 0;
  if (!drift_.none())
    drift_.begin_keyframe(keyframes_.world_to_camera(keyframes_.newest()),
                          static_cast<double>(history_.next_after_keyframe()) - 1);
}

}  // namespace surefield
