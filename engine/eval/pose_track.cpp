#include "engine/eval/pose_track.h"

#include <algorithm>
#include <iterator>
#include <vector>

#include "engine/types/median.h"

namespace surefield {

PoseTrack::PoseTrack(const Trajectory& trajectory) {
  for (const StampedPose& pose : trajectory) {
    if (pose.is_finite() && !pose.lost) poses_.push_back(pose);
  }
  std::stable_sort(poses_.begin(), poses_.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.timestamp < b.timestamp; });
  std::vector<double> steps;
  for (std::size_t i = 1; i < poses_.size(); ++i) {
    steps.push_back(poses_[i].timestamp - poses_[i - 1].timestamp);
  }
  if (!steps.empty()) spacing_ = median(steps);
}

std::optional<Eigen::Isometry3d> PoseTrack::at(double time) const {
  const auto after =
      std::lower_bound(poses_.begin(), poses_.end(), time,
                       [](const StampedPose& pose, double stamp) { return pose.timestamp < stamp; });
  if (after == poses_.end()) return std::nullopt;
  if (after->timestamp == time) return after->camera_to_world;
  if (after == poses_.begin()) return std::nullopt;
  const auto before = std::prev(after);
  const double step = after->timestamp - before->timestamp;
  if (step > 3 * spacing_) return std::nullopt;
  const double t = (time - before->timestamp) / step;
  const Eigen::Quaterniond a(before->camera_to_world.linear()), b(after->camera_to_world.linear());
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = a.slerp(t, b).toRotationMatrix();
  pose.translation() =
      (1 - t) * before->camera_to_world.translation() + t * after->camera_to_world.translation();
  return pose;
}

}  // namespace surefield
