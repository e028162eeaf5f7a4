#pragma once

#include <optional>
#include <vector>

#include "engine/slam/frame_report.h"
#include "engine/slam/keyframe_graph.h"
#include "engine/types/trajectory.h"

namespace surefield {

/// What became of a frame, and its pose relative to the keyframe that it was tracked after, so that it
/// follows that keyframe's refinement.
struct FrameRecord {
  FrameReport report;
  int keyframe = -1;       ///< that it is, or that it was tracked after; -1: the world
  int tracked_after = -1;  ///< of a keyframe: the one before; -1: none
  Pose keyframe_to_frame = Pose::Identity();
};

/// All frames of a run, one record each, in the order in which they were fed.
class FrameHistory {
 public:
  explicit FrameHistory(const KeyframeGraph& keyframes) : keyframes_(keyframes) {}

  /// Adds a frame that was tracked after keyframes.anchor(), or found at another; `report` has its pose.
  void add(const FrameReport& report);
  /// Takes the frame that was added last back out.
  void drop_last() { records_.pop_back(); }
  /// The newest keyframe is the frame that was added last.
  void make_last_keyframe();

  bool empty() const { return records_.empty(); }
  std::size_t size() const { return records_.size(); }
  FrameReport& last_report() { return records_.back().report; }
  const FrameReport& last_report() const { return records_.back().report; }
  /// The keyframe after which the last frame, which has become one, was tracked; -1: none.
  int last_tracked_after() const { return records_.back().tracked_after; }
  const FrameReport& report(std::size_t i) const { return records_[i].report; }
  /// Frames since the last one that became a keyframe, the next one included.
  std::size_t next_after_keyframe() const { return records_.size() - last_keyframe_; }

  /// The pose of a frame as it is known now.
  Pose world_to_camera(std::size_t i) const;
  /// All of them, camera to world.
  Trajectory trajectory() const;
  std::vector<FrameReport> reports() const;
  /// The medians of the gains of the frames that are not lost; none where those are 1.
  std::optional<Eigen::Vector3f> usual_gains() const;
  /// Multiplies the gains of all frames.
  void multiply_gains(const Eigen::Vector3f& factors);

 private:
  const KeyframeGraph& keyframes_;
  std::vector<FrameRecord> records_;
  std::size_t last_keyframe_ = 0;  ///< position among the frames
};

}  // namespace surefield
