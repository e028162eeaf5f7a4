#pragma once

#include <chrono>
#include <optional>
#include <random>
#include <stop_token>
#include <utility>
#include <vector>

#include "engine/slam/active_region.h"
#include "engine/slam/frame_report.h"
#include "engine/slam/keyframe_graph.h"

namespace surefield {

/// Which keyframes the steps of one mapping call visit, and whose poses they refine.
struct MappingPlan {
  std::vector<int> first_half;
  std::vector<int> second_half;
  std::vector<int> refined;
};

/// Keeps the map: gives birth to Gaussians, optimises them over keyframes, takes back what is uncertain,
/// splits and removes, and has on the device what is worked on. Every random choice of a run is drawn here.
class MapUpkeep {
 public:
  /// All of them outlive this; `settings` may change from frame to frame.
  /// Where `stop` is asked for, what remains of mapping is left out.
  MapUpkeep(SplatEngine& engine, const SlamSettings& settings, KeyframeGraph& keyframes, std::stop_token stop)
      : engine_(engine),
        stop_(std::move(stop)),
        settings_(settings),
        keyframes_(keyframes),
        region_(engine, settings),
        random_(static_cast<uint32_t>(settings.seed)) {}

  /// Before a frame is tracked: has on the device what it sees from about `world_to_camera`. `points` are its
  /// sample_points(). The map stays the same.
  void approach(const std::vector<Eigen::Vector3f>& points, const Pose& world_to_camera) {
    region_.approach(keyframes_.all(), points, world_to_camera);
  }

  /// Begins the map with what the first keyframe, `frame`, sees.
  void begin(const Frame& frame);
  /// Adds what the newest keyframe, whose mapping image is `frame`, sees and the map does not show, and
  /// settles on the keyframes near it that the next steps work with.
  void spawn(const Frame& frame);
  /// Those keyframes, the newest included.
  const std::vector<int>& near() const { return region_.near(); }
  /// Draws the order of a mapping call over a window.
  MappingPlan plan(const KeyframeWindow& window);

  /// Keyframes for steps after a loop was closed: the last window, and those around the one that the camera
  /// has come back to, in turns. What they see is on the device then.
  std::vector<int> plan_both(int back_at);

  /// What mapping does from here on ends after so many milliseconds, as far as steps can be left out: all but
  /// one of each call. 0: it has the time it takes.
  void give_time(double milliseconds);

  /// Optimises the map over these keyframes, one step each, and the poses of those of `refined`; takes up to
  /// `share` of the time that is left.
  void optimise(const std::vector<int>& order, const std::vector<int>& refined, FrameReport& report,
                double share = 1);
  /// Takes the opacity from Gaussians that are uncertain over these keyframes.
  void judge(const std::vector<int>& members, FrameReport& report);
  /// Splits, clones and removes Gaussians.
  void densify();

 private:
  SplatEngine& engine_;
  MappingLimit limit(double share) const;

  const std::stop_token stop_;
  std::optional<std::chrono::steady_clock::time_point> until_;  ///< the end of the time for mapping
  const SlamSettings& settings_;
  KeyframeGraph& keyframes_;
  ActiveRegion region_;
  std::mt19937 random_;
  double extent_ = 1;  ///< of the scene, metres
  double pixel_ = 1;   ///< what one covers at that distance, metres
};

}  // namespace surefield
