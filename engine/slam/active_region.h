#pragma once

#include <vector>

#include "engine/slam/keyframes.h"
#include "engine/slam/settings.h"

namespace surefield {

/// Keeps the part of the map on the device that the camera and the keyframes near it see, so that neither the
/// time nor the device memory of a frame depends on how long the run has lasted.
class ActiveRegion {
 public:
  ActiveRegion(SplatEngine& engine, const SlamSettings& settings);

  /// Before a frame is tracked: brings back what it sees from about `world_to_camera`. `points` are its
  /// sample_points().
  void approach(const std::vector<Keyframe>& keyframes, const std::vector<Eigen::Vector3f>& points,
                const Pose& world_to_camera);

  /// Before the newest keyframe's `births` Gaussians are added: settles on the keyframes near it that mapping
  /// works with, whose views are then on the device. Those of `similar` are among them as far as the device
  /// holds them, wherever they are.
  void settle(const std::vector<Keyframe>& keyframes, const std::vector<int>& similar, uint32_t births);

  /// Those keyframes, the newest included: positions in the list of keyframes.
  const std::vector<int>& near() const { return near_; }

 private:
  SplatEngine& engine_;
  int most_;
  std::vector<int> near_{0};
};

}  // namespace surefield
