#include "engine/splat/map_blocks.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace surefield {

namespace {

// Device memory of a Gaussian with SH of degree 0: everything in GaussianMap, TileLists and Rasteriser that
// has an entry for each, and half of that again, by which arrays grow ahead. Those of the sorts, which
// exchange memory, have an entry for each instance.
constexpr uint64_t kBytesPerGaussian = 520;
// Moving out takes a while: less than this part of what is on the device stays where it is, if there is room.
constexpr uint32_t kWorthMoving = 8;

}  // namespace

uint64_t MapBlocks::limit(const GaussianMap& map) const {
  const auto higher = static_cast<uint64_t>(sh_coefficients(map.sh_degree()) - 1);
  // Coefficient, its moments and its gradient.
  return budget_ / (kBytesPerGaussian + higher * 4 * sizeof(glsl::vec3) * 3 / 2);
}

bool MapBlocks::is_whole(const GaussianMap& map, uint32_t births) const {
  return parked_ == 0 && uint64_t{map.size()} + births <= limit(map);
}

MapBlocks::Block MapBlocks::block_of(const Eigen::Vector3f& point) {
  Block block;
  for (int axis = 0; axis < 3; ++axis) {
    // What is not a number, or out of all bounds, has to be somewhere.
    const float at = std::floor(point[axis] / kEdge);
    block[static_cast<std::size_t>(axis)] = std::abs(at) < 1e9f ? static_cast<int>(at) : 0;
  }
  return block;
}

/// The blocks of the points, then those beside them.
std::vector<MapBlocks::Block> MapBlocks::near(const WorldPoints& points) {
  std::set<Block> own, all;
  for (const Eigen::Vector3f& point : points) own.insert(block_of(point));
  for (const Block& b : own)
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) all.insert({b[0] + dx, b[1] + dy, b[2] + dz});
  std::vector<Block> blocks(own.begin(), own.end());
  std::set_difference(all.begin(), all.end(), own.begin(), own.end(), std::back_inserter(blocks));
  return blocks;
}

/// The block of every Gaussian on the device.
std::vector<MapBlocks::Block> MapBlocks::homes(const GaussianMap& map) {
  std::vector<Block> blocks;
  blocks.reserve(map.size());
  for (const glsl::vec3& mean : map.means.value.download(map.size()))
    blocks.push_back(block_of({mean.x, mean.y, mean.z}));
  return blocks;
}

uint32_t MapBlocks::count_parked(const GaussianMap& map, const std::set<Block>& wanted) const {
  std::size_t words = 0;
  for (const auto& [block, records] : blocks_)
    if (wanted.contains(block)) words += records.size();
  return static_cast<uint32_t>(words / map.record_words());
}

bool MapBlocks::recall(GaussianMap& map, const WorldPoints& points) {
  if (parked_ == 0) return true;
  const std::vector<Block> blocks = near(points);
  const std::set<Block> wanted(blocks.begin(), blocks.end());
  if (uint64_t{map.size()} + count_parked(map, wanted) > limit(map)) return false;
  bring(map, wanted);
  return true;
}

int MapBlocks::focus(GaussianMap& map, std::span<const WorldPoints> regions, uint32_t births) {
  const std::vector<Block> blocks_of_map = homes(map);
  std::map<Block, uint64_t> counts;
  for (const Block& block : blocks_of_map) ++counts[block];
  for (const auto& [block, records] : blocks_) counts[block] += records.size() / map.record_words();

  std::set<Block> wanted;
  uint64_t total = births;
  int whole = 0;
  for (const WorldPoints& region : regions) {
    std::set<Block> with_region = wanted;
    uint64_t with_more = total;
    for (const Block& block : near(region)) {
      const auto found = counts.find(block);
      if (found == counts.end() || wanted.contains(block)) continue;
      // Of the first region, there is at least as much as there is room for.
      if (whole == 0 && with_more + found->second > limit(map)) break;
      with_region.insert(block);
      with_more += found->second;
    }
    if (with_more > limit(map) && whole > 0) break;
    wanted = std::move(with_region);
    total = with_more;
    ++whole;
  }
  const uint64_t after = uint64_t{map.size()} + count_parked(map, wanted) + births;
  const auto idle = std::count_if(blocks_of_map.begin(), blocks_of_map.end(),
                                  [&](const Block& block) { return !wanted.contains(block); });
  if (idle > 0 && (after > limit(map) || idle > map.size() / kWorthMoving)) park(map, blocks_of_map, wanted);
  bring(map, wanted);
  return whole;
}

/// Moves everything that is not wanted to host memory.
void MapBlocks::park(GaussianMap& map, std::span<const Block> homes, const std::set<Block>& wanted) {
  std::vector<uint32_t> order(map.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto leaving = std::stable_partition(order.begin(), order.end(),
                                             [&](uint32_t i) { return wanted.contains(homes[i]); });
  const auto kept = static_cast<uint32_t>(leaving - order.begin());
  rebuild_.rebuild(map, order);
  const std::vector<uint32_t> records = map.read_records(kept);
  const uint32_t words = map.record_words();
  for (std::size_t i = kept; i < order.size(); ++i) {
    const auto record = records.begin() + static_cast<std::ptrdiff_t>((i - kept) * words);
    std::vector<uint32_t>& block = blocks_[homes[order[i]]];
    block.insert(block.end(), record, record + words);
  }
  parked_ += map.size() - kept;
  map.set_size(kept);
}

void MapBlocks::bring(GaussianMap& map, const std::set<Block>& wanted) {
  std::vector<uint32_t> records;
  for (auto entry = blocks_.begin(); entry != blocks_.end();) {
    if (!wanted.contains(entry->first)) {
      ++entry;
      continue;
    }
    records.insert(records.end(), entry->second.begin(), entry->second.end());
    entry = blocks_.erase(entry);
  }
  if (records.empty()) return;
  map.append_records(records);
  parked_ -= static_cast<uint32_t>(records.size() / map.record_words());
}

void MapBlocks::move(GaussianMap& map, std::span<const glsl::AnchorMotion> motions) {
  const RecordMover mover(map, motions);
  const std::size_t words = map.record_words();
  std::map<Block, std::vector<uint32_t>> arrivals;
  for (auto& [block, records] : blocks_) {
    std::size_t kept = 0;
    for (std::size_t at = 0; at < records.size(); at += words) {
      const std::span record = std::span(records).subspan(at, words);
      const Block home = mover.move(record) ? block_of(mover.mean(record)) : block;
      if (home != block) {
        std::vector<uint32_t>& other = arrivals[home];
        other.insert(other.end(), record.begin(), record.end());
        continue;
      }
      if (kept != at)
        std::copy(record.begin(), record.end(), records.begin() + static_cast<std::ptrdiff_t>(kept));
      kept += words;
    }
    records.resize(kept);
  }
  for (auto& [block, records] : arrivals) {
    std::vector<uint32_t>& home = blocks_[block];
    home.insert(home.end(), records.begin(), records.end());
  }
  std::erase_if(blocks_, [](const auto& entry) { return entry.second.empty(); });
}

void MapBlocks::append_to(GaussianCloud& cloud, const GaussianMap& map) const {
  for (const auto& entry : blocks_) surefield::append_to(cloud, entry.second, map.record_words());
}

void MapBlocks::clear() {
  blocks_.clear();
  parked_ = 0;
}

}  // namespace surefield
