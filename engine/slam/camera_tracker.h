#pragma once

#include <deque>
#include <functional>

#include "engine/slam/depth_timing.h"
#include "engine/slam/frame_features.h"
#include "engine/slam/frame_history.h"
#include "engine/slam/keyframe_graph.h"
#include "engine/slam/pose_covariance.h"
#include "engine/slam/simulated_drift.h"

namespace surefield {

/// How well a frame fits the map at its pose.
struct TrackingFit {
  double loss = 0;
  double share = 0;         ///< what the map explains of the depth that is compared
  double explained = 0;     ///< of all of the sensor's depth
  double seen_through = 0;  ///< of the same, what sees through the map
  PredictionError error;    ///< of constant velocity
};

/// Finds where the camera is: predicts its pose, tracks it in the map as it stands, and judges how far the
/// result is to be trusted. Remembers how well it went of late.
class CameraTracker {
 public:
  /// All of them outlive the tracker; `settings` may change from frame to frame.
  CameraTracker(SplatEngine& engine, const SlamSettings& settings, const Intrinsics& intrinsics,
                const KeyframeGraph& keyframes, const FrameHistory& history)
      : engine_(engine),
        settings_(settings),
        intrinsics_(intrinsics),
        keyframes_(keyframes),
        history_(history),
        drift_(settings.drift) {}

  /// Where the next frame is thought to be, world to camera. Needs a frame before it.
  Pose predict() const;
  /// The motion to the last frame; none where one of the two is lost.
  std::optional<CameraMotion> last_motion() const;
  /// Says what last_motion() is as long as there is only one frame.
  void expect(const CameraMotion& motion) { expected_ = motion; }
  /// Has on the device what a frame sees from a pose.
  using Approach = std::function<void(const Pose&)>;
  /// Tracks a frame from `start`, and where that fails from other poses, told by its features: near the last
  /// keyframes, then in the whole map, of which `approach` is asked for the part. Fills the report's pose and
  /// what it says of tracking. The pose of a lost frame is the last one that was known. Changes nothing else.
  void track(FrameHandle image, FrameFeatures& features, const Pose& start, const Approach& approach,
             FrameReport& report) const;
  /// Finds the camera in the whole map by the frame alone, wherever it was before; the report says that it is
  /// lost where no pose is to be trusted. Changes nothing else.
  void locate(FrameHandle image, FrameFeatures& features, const Approach& approach,
              FrameReport& report) const;
  /// Whether the map explains so much less of a frame's depth than of that of the first frame tracked after
  /// the last keyframe that there should be another.
  bool sees_unmapped(const FrameReport& report) const;

  /// The frame that was tracked counts.
  void accept(const FrameReport& report);
  /// There is a new keyframe, the frame that was added last; the history does not know of it yet.
  void begin_keyframe();

 private:
  TrackingFit usual_fit() const;
  TrackingState state_of(const TrackingResult& result) const;
  bool is_near_last(const Pose& world_to_camera) const;
  bool is_better(const TrackingResult& result, const TrackingResult& other) const;
  std::optional<PredictionError> last_error() const;
  TrackingResult align_to_newest(FrameHandle image, const Pose& start,
                                 const TrackingSettings& tracking) const;
  TrackingResult align(FrameHandle image, const Pose& start, const TrackingSettings& tracking) const;
  TrackingResult retry(FrameHandle image, FrameFeatures& features, const TrackingSettings& tracking,
                       TrackingResult best, FrameReport& report) const;
  void tell(const TrackingResult& result, FrameReport& report) const;
  TrackingResult find_again(FrameHandle image, FrameFeatures& features, const TrackingSettings& tracking,
                            const Approach& approach, TrackingResult best, FrameReport& report) const;
  std::optional<Pose> pose_by_features(FrameFeatures& features) const;

  SplatEngine& engine_;
  const SlamSettings& settings_;
  const Intrinsics intrinsics_;
  const KeyframeGraph& keyframes_;
  const FrameHistory& history_;
  SimulatedDrift drift_;
  std::deque<TrackingFit> recent_;        ///< of the last good frames
  std::optional<CameraMotion> expected_;  ///< to the second frame, once it has been tracked for that alone
  double valid_after_keyframe_ = 0;       ///< valid_fraction of the first frame tracked after it; 0: none yet
};

}  // namespace surefield
