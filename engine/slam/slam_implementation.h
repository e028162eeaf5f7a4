#pragma once

#include <deque>
#include <optional>
#include <random>
#include <stdexcept>

#include "engine/slam/active_region.h"
#include "engine/slam/covisibility.h"
#include "engine/slam/keyframes.h"
#include "engine/slam/slam.h"

namespace surefield {

/// A frame's pose relative to the keyframe that it was tracked after, so that it follows that keyframe's
/// refinement.
struct TrackedFrame {
  double timestamp = 0;
  int keyframe = 0;
  Pose keyframe_to_frame = Pose::Identity();
};

/// The state of a run. What becomes of a frame: slam.cpp; tracking: slam_tracking.cpp; mapping:
/// slam_mapping.cpp.
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
  double valid_after_keyframe = 0;  ///< valid_fraction of the first frame tracked after it; 0: none yet

  Implementation(const SlamSettings& s, const Intrinsics& k, const EngineOptions& options)
      : settings(s),
        intrinsics(k),
        covisibility(s.keyframes),
        engine(options),
        region(engine, s),
        random(static_cast<uint32_t>(s.seed)) {}

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

}  // namespace surefield
