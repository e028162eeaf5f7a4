#include "engine/slam/camera_tracker.h"

#include <algorithm>
#include <numeric>

namespace surefield {

namespace {

constexpr std::size_t kRecentLosses = 10;  // frames whose tracking loss is the measure of a jump

}  // namespace

/// Constant velocity: the last pose moved on by the last motion.
Pose CameraTracker::predict() const {
  const std::size_t n = history_.size();
  if (n < 2) return history_.world_to_camera(n - 1);
  const Pose last = history_.world_to_camera(n - 1);
  return last * history_.world_to_camera(n - 2).inverse() * last;
}

void CameraTracker::track(FrameHandle image, const Pose& start, FrameReport& report) const {
  TrackingSettings tracking = settings_.tracking;
  if (history_.size() == 1)
    tracking.adam.iterations = std::max(tracking.adam.iterations, tracking.adam.first_iterations);
  TrackingResult result = engine_.track(image, {intrinsics_, start}, tracking, keyframes_.references());
  report.tracking_iterations = result.iterations;
  report.tracking_ms = result.milliseconds;
  if (looks_lost(result)) result = retry(image, tracking, result, report);
  report.lost = looks_lost(result);
  report.world_to_camera = result.world_to_camera;
  report.tracking_loss = result.loss;
  report.valid_fraction = result.valid_fraction;
}

/// Other starting poses: no motion since the last frame, and the last keyframe's pose.
TrackingResult CameraTracker::retry(FrameHandle image, const TrackingSettings& tracking, TrackingResult best,
                                    FrameReport& report) const {
  TrackingSettings patient = tracking;
  patient.adam.iterations *= 2;
  patient.gauss_newton.renders *= 2;
  for (const Pose& start :
       {history_.world_to_camera(history_.size() - 1), keyframes_.world_to_camera(keyframes_.newest())}) {
    if (!looks_lost(best)) break;
    const TrackingResult other = engine_.track(image, {intrinsics_, start}, patient, keyframes_.references());
    ++report.retries;
    report.tracking_iterations += other.iterations;
    report.tracking_ms += other.milliseconds;
    const bool enough = std::min(best.valid_fraction, other.valid_fraction) >= settings_.lost.minimum_valid;
    const bool better = enough ? other.loss < best.loss : other.valid_fraction > best.valid_fraction;
    if (better || !looks_lost(other)) best = other;
  }
  return best;
}

bool CameraTracker::looks_lost(const TrackingResult& result) const {
  if (result.valid_fraction < settings_.lost.minimum_valid) return true;
  if (recent_losses_.empty()) return false;
  const double mean = std::accumulate(recent_losses_.begin(), recent_losses_.end(), 0.0) /
                      static_cast<double>(recent_losses_.size());
  return result.loss > settings_.lost.loss_jump * mean;
}

bool CameraTracker::sees_unmapped(const FrameReport& report) const {
  const double after_keyframe = valid_after_keyframe_ == 0 ? report.valid_fraction : valid_after_keyframe_;
  return report.valid_fraction < settings_.keyframes.valid_below * after_keyframe;
}

void CameraTracker::accept(const FrameReport& report) {
  if (report.lost) return;
  if (valid_after_keyframe_ == 0) valid_after_keyframe_ = report.valid_fraction;
  recent_losses_.push_back(report.tracking_loss);
  if (recent_losses_.size() > kRecentLosses) recent_losses_.pop_front();
}

}  // namespace surefield
