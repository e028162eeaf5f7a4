#include <algorithm>
#include <numeric>

#include "engine/slam/slam_implementation.h"

namespace surefield {

namespace {

constexpr std::size_t kRecentLosses = 10;  // frames whose tracking loss is the measure of a jump

}  // namespace

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
    if (valid_after_keyframe == 0) valid_after_keyframe = result.valid_fraction;
    recent_losses.push_back(result.loss);
    if (recent_losses.size() > kRecentLosses) recent_losses.pop_front();
  }
  const int reference = static_cast<int>(keyframes.size()) - 1;
  frames.push_back({report.timestamp, reference,
                    result.world_to_camera * keyframes[reference].camera.world_to_camera.inverse()});
}

}  // namespace surefield
