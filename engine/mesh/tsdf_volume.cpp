// The only file that knows OpenVDB, which is slow to compile.
#include "engine/mesh/tsdf_volume.h"

#include <openvdb/openvdb.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <unordered_set>
#include <vector>

#include "engine/mesh/depth_sampler.h"
#include "engine/mesh/surface_builder.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

using openvdb::Coord;
using DistanceLeaf = openvdb::FloatTree::LeafNodeType;
using ColourLeaf = openvdb::Vec3STree::LeafNodeType;

constexpr int kBlock = DistanceLeaf::DIM;
constexpr int kLargestCoordinate = 1 << 19;  // voxels; what SurfaceBuilder can tell apart
constexpr float kLeastDropOff = 1e-3f;       // weight just before the end of the band behind the surface

struct CoordHash {
  std::size_t operator()(const Coord& c) const { return c.hash<20>(); }
};

/// The three fields of a block: distance (metres, negative behind the surface), colour, and the weight that
/// they are averages over.
struct Block {
  DistanceLeaf* distance = nullptr;
  DistanceLeaf* weight = nullptr;
  ColourLeaf* colour = nullptr;
};

/// All blocks.
struct Fields {
  openvdb::FloatTree distance{0.0f};
  openvdb::FloatTree weight{0.0f};
  openvdb::Vec3STree colour{openvdb::Vec3s(0.0f)};
  std::vector<Block> blocks;  ///< in the order in which they were made
};

void check_settings(const TsdfSettings& settings) {
  if (!(settings.voxel >= 1e-4 && settings.voxel <= 10)) {
    throw InputError("the voxel must measure 0.0001 to 10 m");
  }
  if (!(settings.truncation >= 2 * settings.voxel && settings.truncation <= 100 * settings.voxel)) {
    throw InputError("the truncation must be 2 to 100 voxels, or surfaces get holes");
  }
}

void check_view(const DepthView& view) {
  const auto pixels = static_cast<std::size_t>(view.camera.intrinsics.width) * view.camera.intrinsics.height;
  if (view.depth.size() != pixels || (!view.colour.empty() && view.colour.size() != 3 * pixels)) {
    throw UsageError("a depth view's images do not have the size of its intrinsics");
  }
}

/// Compares the voxels of one block with a view.
class BlockUpdate {
 public:
  BlockUpdate(const TsdfSettings& settings, const DepthView& view)
      : k_(view.camera.intrinsics),
        rotation_(view.camera.world_to_camera.linear() * settings.voxel),
        translation_(view.camera.world_to_camera.translation()),
        sampler_(view, settings.truncation),
        voxel_(static_cast<float>(settings.voxel)),
        truncation_(static_cast<float>(settings.truncation)),
        noise_(view.noise) {}

  /// Whether some of the block may lie in the image.
  bool may_see(const Coord& origin) const {
    const Eigen::Vector3d centre = camera_point(origin.offsetBy(kBlock / 2));
    const double radius = 0.5 * std::sqrt(3.0) * kBlock * voxel_;
    if (centre.z() < -radius) return false;
    if (centre.z() < 2 * radius) return true;  // too near to tell
    const double margin = 2 * radius / centre.z();
    const double u = k_.fx * centre.x() / centre.z() + k_.cx;
    const double v = k_.fy * centre.y() / centre.z() + k_.cy;
    const double margin_u = margin * std::abs(k_.fx) * (1 + std::abs(u - k_.cx) / std::abs(k_.fx));
    const double margin_v = margin * std::abs(k_.fy) * (1 + std::abs(v - k_.cy) / std::abs(k_.fy));
    return u > -margin_u && v > -margin_v && u < k_.width + margin_u && v < k_.height + margin_v;
  }

  void apply(const Block& block) const {
    const Coord origin = block.distance->origin();
    for (openvdb::Index i = 0; i < DistanceLeaf::SIZE; ++i) {
      const Eigen::Vector3d point = camera_point(origin + DistanceLeaf::offsetToLocalCoord(i));
      if (!(point.z() > 0)) continue;
      const auto sample =
          sampler_.at(k_.fx * point.x() / point.z() + k_.cx, k_.fy * point.y() / point.z() + k_.cy);
      if (sample) update(block, i, *sample, sample->depth - static_cast<float>(point.z()));
    }
  }

 private:
  Eigen::Vector3d camera_point(const Coord& c) const {
    return rotation_ * Eigen::Vector3d(c.x(), c.y(), c.z()) + translation_;
  }

  void update(const Block& block, openvdb::Index i, const DepthSample& sample, float distance) const {
    if (distance <= -truncation_) return;
    const float before = block.weight->getValue(i);
    const float weight = weight_at(distance) * certainty_of(sample.depth);
    const float after = before + weight;
    const float share = weight / after;
    const float old_distance = block.distance->getValue(i);
    block.distance->setValueOnly(i, old_distance + share * (std::min(distance, truncation_) - old_distance));
    block.weight->setValueOnly(i, after);
    if (distance > truncation_) return;  // that colour belongs to another surface
    const openvdb::Vec3s old = block.colour->getValue(i);
    const openvdb::Vec3s seen(sample.colour.x(), sample.colour.y(), sample.colour.z());
    block.colour->setValueOnly(i, old + share * (seen - old));
  }

  /// 1 up to one voxel behind the surface, then falling to 0: the other side of a thin object should not be
  /// pushed away by what is seen from this side.
  float weight_at(float distance) const {
    return std::clamp((distance + truncation_) / (truncation_ - voxel_), kLeastDropOff, 1.0f);
  }

  /// 1 at a metre.
  float certainty_of(float depth) const {
    const double ratio = noise_.sigma(1) / noise_.sigma(depth);
    return static_cast<float>(ratio * ratio);
  }

  Intrinsics k_;
  Eigen::Matrix3d rotation_;  ///< times the voxel size
  Eigen::Vector3d translation_;
  DepthSampler sampler_;
  float voxel_;
  float truncation_;
  DepthNoise noise_;
};

/// Makes room for the blocks that a view needs. Points are in voxels.
class BlockToucher {
 public:
  explicit BlockToucher(Fields& fields) : fields_(fields) {}

  void touch(const Eigen::Vector3d& point) {
    if (!(point.cwiseAbs().maxCoeff() < kLargestCoordinate - 2 * kBlock)) {
      throw UsageError("a depth lies too far from the origin for voxels of this size");
    }
    const Eigen::Vector3i voxel = point.array().floor().cast<int>();
    const Coord origin = Coord(voxel.x(), voxel.y(), voxel.z()) & ~(kBlock - 1);
    if (origin == last_) return;
    last_ = origin;
    if (!seen_.insert(origin).second || fields_.distance.probeLeaf(origin)) return;
    fields_.blocks.push_back({fields_.distance.touchLeaf(origin), fields_.weight.touchLeaf(origin),
                              fields_.colour.touchLeaf(origin)});
  }

  /// All blocks that hold corners of the cells at a point of the surface.
  void touch_around(const Eigen::Vector3d& point) {
    constexpr double kReach = 2;
    for (int i = 0; i < 8; ++i) {
      touch(point + kReach * Eigen::Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
    }
  }

 private:
  Fields& fields_;
  std::unordered_set<Coord, CoordHash> seen_;
  Coord last_ = Coord::max();
};

}  // namespace

struct TsdfVolume::Implementation {
  TsdfSettings settings;
  Fields fields;

  void touch_blocks(const DepthView& view);
  void add_cells(const Block& block, SurfaceBuilder& builder) const;
};

/// Makes room wherever the view's depth, give or take the truncation, lies: in the blocks at points along
/// each ray that are half a block apart or nearer, and in those around the surface itself.
void TsdfVolume::Implementation::touch_blocks(const DepthView& view) {
  const Intrinsics& k = view.camera.intrinsics;
  const Pose to_world = view.camera.world_to_camera.inverse();
  const DepthSampler sampler(view, settings.truncation);
  BlockToucher toucher(fields);
  for (int v = 0; v < k.height; ++v) {
    for (int u = 0; u < k.width; ++u) {
      const auto z = sampler.pixel_depth(u, v);
      if (!z) continue;
      const Eigen::Vector3d ray((u - k.cx) / k.fx, (v - k.cy) / k.fy, 1);
      const double length = 2 * settings.truncation * ray.norm() / settings.voxel;
      const int steps = static_cast<int>(std::ceil(length / (0.5 * kBlock)));
      for (int s = 0; s <= steps; ++s) {
        const double depth = *z + settings.truncation * (2.0 * s / steps - 1);
        if (depth > 0) toucher.touch((to_world * (depth * ray)) / settings.voxel);
      }
      toucher.touch_around((to_world * (*z * ray)) / settings.voxel);
    }
  }
}

void TsdfVolume::Implementation::add_cells(const Block& block, SurfaceBuilder& builder) const {
  openvdb::tree::ValueAccessor<const openvdb::FloatTree> distances(fields.distance);
  openvdb::tree::ValueAccessor<const openvdb::FloatTree> weights(fields.weight);
  openvdb::tree::ValueAccessor<const openvdb::Vec3STree> colours(fields.colour);
  std::array<CellCorner, kCellCorners> corners;
  const auto read = [&](const Coord& cell) {
    int inside = 0;
    for (int i = 0; i < kCellCorners; ++i) {
      const Coord at = cell.offsetBy(i & 1, i >> 1 & 1, i >> 2 & 1);
      if (weights.getValue(at) == 0) return false;
      CellCorner& corner = corners[static_cast<std::size_t>(i)];
      corner.distance = distances.getValue(at);
      inside += corner.distance < 0 ? 1 : 0;
    }
    if (inside == 0 || inside == kCellCorners) return false;
    for (int i = 0; i < kCellCorners; ++i) {
      const openvdb::Vec3s c = colours.getValue(cell.offsetBy(i & 1, i >> 1 & 1, i >> 2 & 1));
      corners[static_cast<std::size_t>(i)].colour = {c.x(), c.y(), c.z()};
    }
    return true;
  };
  for (openvdb::Index i = 0; i < DistanceLeaf::SIZE; ++i) {
    const Coord cell = block.distance->offsetToGlobalCoord(i);
    if (read(cell)) builder.add_cell({cell.x(), cell.y(), cell.z()}, corners);
  }
}

TsdfVolume::TsdfVolume(const TsdfSettings& settings) : implementation_(std::make_unique<Implementation>()) {
  check_settings(settings);
  implementation_->settings = settings;
}

TsdfVolume::~TsdfVolume() = default;

void TsdfVolume::integrate(const DepthView& view) {
  check_view(view);
  Implementation& s = *implementation_;
  s.touch_blocks(view);
  const BlockUpdate update(s.settings, view);
  // Each block is one task's alone, so the number of threads changes nothing.
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, s.fields.blocks.size(), 64), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const Block& block = s.fields.blocks[i];
      if (update.may_see(block.distance->origin())) update.apply(block);
    }
  });
}

TriangleMesh TsdfVolume::extract() const {
  SurfaceBuilder builder(implementation_->settings.voxel);
  for (const Block& block : implementation_->fields.blocks) implementation_->add_cells(block, builder);
  return builder.take();
}

std::size_t TsdfVolume::blocks() const {
  return implementation_->fields.blocks.size();
}

std::size_t TsdfVolume::bytes() const {
  const Fields& fields = implementation_->fields;
  return fields.distance.memUsage() + fields.weight.memUsage() + fields.colour.memUsage();
}

}  // namespace surefield
