#pragma once

#include <span>
#include <vector>

#include "engine/splat/gaussian_map.h"
#include "engine/types/camera.h"
#include "shaders/shared/move_gaussians.h"

namespace surefield {

/// Motions of the world as the device reads them, one for each anchor (GaussianCloud::anchors).
std::vector<glsl::AnchorMotion> to_device(std::span<const Pose> motions);

/// Moves Gaussians with the keyframes that they were born in, on the device. Spherical harmonics above degree
/// 0 do not turn: SLAM's maps have none.
class AnchorMover {
 public:
  explicit AnchorMover(gpu::Device& device);

  void move(GaussianMap& map, std::span<const glsl::AnchorMotion> motions);

 private:
  gpu::Device& device_;
  gpu::Pass<passes::move_gaussians> pass_;
  gpu::Array<glsl::AnchorMotion> motions_;
};

/// The same for records of GaussianMap that wait in host memory.
class RecordMover {
 public:
  /// Both outlive it.
  RecordMover(GaussianMap& map, std::span<const glsl::AnchorMotion> motions);

  /// Moves one Gaussian; returns whether it had a motion.
  bool move(std::span<uint32_t> record) const;
  /// Its centre.
  Eigen::Vector3f mean(std::span<const uint32_t> record) const;

 private:
  std::span<const glsl::AnchorMotion> motions_;
  uint32_t mean_, mean_moments_[2], rotation_, rotation_moments_[2], anchor_;  ///< words of a record
};

}  // namespace surefield
