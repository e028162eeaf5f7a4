#pragma once

#include <array>
#include <map>
#include <set>

#include "engine/splat/anchor_motion.h"
#include "engine/splat/engine.h"
#include "engine/splat/map_rebuild.h"

namespace surefield {

/// The part of a map that is not on the device: blocks of space whose Gaussians wait in host memory, with
/// moments and all, until something near them is looked at. What has been moved out and brought back is bit
/// by bit what it was, at another place in the order.
class MapBlocks {
 public:
  static constexpr float kEdge = 0.5f;  ///< of a block, metres

  explicit MapBlocks(gpu::Device& device) : rebuild_(device) {}

  /// Sets how much device memory the Gaussians of a map may take.
  void set_budget(uint64_t bytes) { budget_ = bytes; }
  /// Gaussians of that map that fit the budget.
  uint64_t limit(const GaussianMap& map) const;

  /// See SplatEngine.
  bool is_whole(const GaussianMap& map, uint32_t births) const;
  bool recall(GaussianMap& map, const WorldPoints& points);
  int focus(GaussianMap& map, std::span<const WorldPoints> regions, uint32_t births);

  /// Moves the Gaussians in host memory with the keyframes that they were born in: motions[a] is that of anchor
  /// a in the world, and what has none stays. Those that come to lie in another block are there from now on.
  void move(GaussianMap& map, std::span<const glsl::AnchorMotion> motions);

  /// Gaussians in host memory.
  uint32_t parked() const { return parked_; }
  /// Adds the Gaussians in host memory to a cloud.
  void append_to(GaussianCloud& cloud, const GaussianMap& map) const;
  void clear();

 private:
  using Block = std::array<int, 3>;  ///< of world coordinates, in edges, rounded down

  static Block block_of(const Eigen::Vector3f& point);
  static std::vector<Block> near(const WorldPoints& points);
  static std::vector<Block> homes(const GaussianMap& map);
  void park(GaussianMap& map, std::span<const Block> homes, const std::set<Block>& wanted);
  void bring(GaussianMap& map, const std::set<Block>& wanted);
  uint32_t count_parked(const GaussianMap& map, const std::set<Block>& wanted) const;

  MapRebuild rebuild_;
  uint64_t budget_ = UINT64_MAX;
  std::map<Block, std::vector<uint32_t>> blocks_;  ///< records of GaussianMap
  uint32_t parked_ = 0;
};

}  // namespace surefield
