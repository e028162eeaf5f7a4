#include "engine/slam/frame_history.h"

#include "engine/types/median.h"

namespace surefield {

void FrameHistory::add(const FrameReport& report) {
  FrameRecord record{.report = report,
                     .keyframe = report.found_at < 0 ? keyframes_.anchor() : report.found_at,
                     .keyframe_to_frame = report.world_to_camera};
  if (!keyframes_.empty())
    record.keyframe_to_frame = report.world_to_camera * keyframes_.world_to_camera(record.keyframe).inverse();
  records_.push_back(record);
}

void FrameHistory::make_last_keyframe() {
  FrameRecord& last = records_.back();
  last.report.keyframe = true;
  last.tracked_after = last.keyframe;
  last.keyframe = keyframes_.newest();
  last.keyframe_to_frame = Pose::Identity();
  last_keyframe_ = records_.size() - 1;
}

Pose FrameHistory::world_to_camera(std::size_t i) const {
  const FrameRecord& record = records_[i];
  if (record.keyframe < 0) return record.keyframe_to_frame;
  return record.keyframe_to_frame * keyframes_.world_to_camera(record.keyframe);
}

Trajectory FrameHistory::trajectory() const {
  Trajectory trajectory;
  for (std::size_t i = 0; i < records_.size(); ++i)
    trajectory.push_back(
        {records_[i].report.timestamp, world_to_camera(i).inverse(), records_[i].report.lost()});
  return trajectory;
}

std::vector<FrameReport> FrameHistory::reports() const {
  std::vector<FrameReport> reports;
  for (const FrameRecord& record : records_) reports.push_back(record.report);
  return reports;
}

std::optional<Eigen::Vector3f> FrameHistory::usual_gains() const {
  std::vector<float> gains[3];
  for (const FrameRecord& record : records_)
    for (int c = 0; c < 3 && !record.report.lost(); ++c) gains[c].push_back(record.report.gains[c]);
  if (gains[0].empty()) return std::nullopt;
  const Eigen::Vector3f usual(median(gains[0]), median(gains[1]), median(gains[2]));
  return usual == Eigen::Vector3f::Ones() ? std::nullopt : std::optional(usual);
}

void FrameHistory::multiply_gains(const Eigen::Vector3f& factors) {
  for (FrameRecord& record : records_) record.report.gains = record.report.gains.cwiseProduct(factors);
}

}  // namespace surefield
