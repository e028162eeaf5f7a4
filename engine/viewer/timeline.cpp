#include "engine/viewer/timeline.h"

#include <algorithm>

namespace surefield {

double Timeline::duration() const {
  return trajectory_.empty() ? 0 : trajectory_.back().timestamp - trajectory_.front().timestamp;
}

double Timeline::seconds_at(int position) const {
  if (trajectory_.empty()) return 0;
  const int last = static_cast<int>(trajectory_.size()) - 1;
  return trajectory_[static_cast<std::size_t>(std::clamp(position, 0, last))].timestamp -
         trajectory_.front().timestamp;
}

int Timeline::position_at(double seconds) const {
  if (trajectory_.empty()) return 0;
  // Seconds since the first are rounded: those of a frame are to lead back to it.
  constexpr double kSlack = 1e-6;
  const double first = trajectory_.front().timestamp;
  const auto later = [&](double t, const StampedPose& pose) { return t < pose.timestamp - first; };
  const auto next = std::upper_bound(trajectory_.begin(), trajectory_.end(), seconds + kSlack, later);
  return std::max(static_cast<int>(next - trajectory_.begin()) - 1, 0);
}

int Playback::advance(const Timeline& timeline, int position, double by) {
  if (timeline.position_at(seconds) != position) seconds = timeline.seconds_at(position);
  seconds += by;
  if (seconds > timeline.duration()) seconds = 0;
  return timeline.position_at(seconds);
}

}  // namespace surefield
