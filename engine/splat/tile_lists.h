#pragma once

#include <functional>

#include "engine/primitives/radix_sort.h"
#include "engine/primitives/scan.h"
#include "engine/splat/gaussian_map.h"
#include "engine/types/depth_model.h"
#include "shaders/shared/compact_visible.h"
#include "shaders/shared/emit_instances.h"
#include "shaders/shared/find_tile_ranges.h"
#include "shaders/shared/gather_tile_counts.h"
#include "shaders/shared/prepare_dispatch.h"
#include "shaders/shared/project_splats.h"

namespace surefield {

/// Shape of the blending kernels: one subgroup of `lanes` invocations works a tile of width x height pixels.
struct TileShape {
  uint32_t width = 8;
  uint32_t height = 8;
  uint32_t lanes = 8;

  /// The shape that suits a device (docs/design.md, "Tiles").
  static TileShape for_device(const gpu::Device& device);
};

/// Size of an image in pixels.
struct ImageSize {
  uint32_t width = 0;
  uint32_t height = 0;

  uint64_t pixels() const { return static_cast<uint64_t>(width) * height; }
};

/// The lists of one view as passes read them. They can be put aside and taken out again
/// (TileLists::exchange()).
struct ViewLists {
  explicit ViewLists(gpu::Device& device);

  gpu::Array<gpu::DispatchArgs> dispatch_args;
  gpu::Array<glsl::uint> visible_count;     ///< 1
  gpu::Array<glsl::uint> visible_ids;       ///< per visible Gaussian, ascending: its index in the map
  gpu::Array<glsl::uint> tile_counts;       ///< per Gaussian of the map: its number of instances
  gpu::Array<glsl::uint> instance_offsets;  ///< per Gaussian of the map: its first instance
  gpu::Array<glsl::uint> instances;         ///< their names, sorted by tile, near to far
  gpu::Array<glsl::uint> tile_gaussians;    ///< in the same order: the instance's Gaussian's index in the map
  gpu::Array<glsl::uvec2> tile_ranges;      ///< per tile: begin and end in `instances`

 private:
  friend class TileLists;
  const gpu::Array<glsl::CameraState>* camera_ = nullptr;  ///< whose lists these are
  int uses_ = 0;                                           ///< of them so far
  uint64_t age_ = 0;                                       ///< TileLists::now_ when they were made
};

/// The projected Gaussians of a view and, for every tile, the list of those that touch it, near to far.
///
/// Per Gaussian: project. Then, for those that touch the image: sort by depth; write one instance per touched
/// tile in that order; sort stably by tile. An instance is named by its place in the order of the map,
/// where the instances of one Gaussian lie side by side.
class TileLists : public ViewLists {
 public:
  TileLists(gpu::Device& device, const TileShape& shape);

  /// Records everything for one view, without Gaussians whose uncertainty is above `uncertainty_above` (m^2).
  /// Buffers grow first if the map or the image did.
  void record(gpu::Recorder& recorder, const GaussianMap& map, const gpu::Array<glsl::CameraState>& camera,
              const ImageSize& size, float uncertainty_above);

  /// Records the projection alone: the lists of the last record(), of the same map and image, are used again.
  /// For a camera and Gaussians that have hardly moved since.
  void record_again(gpu::Recorder& recorder, const GaussianMap& map,
                    const gpu::Array<glsl::CameraState>& camera, float uncertainty_above);
  /// Whether the lists are of this camera, and fresh enough for Gaussians that mapping moves.
  bool serve(const gpu::Array<glsl::CameraState>& camera) const {
    return camera_ == &camera && age_ == now_ && uses_ < kUses;
  }
  /// Puts the lists at hand aside, and takes out what `other` holds.
  void exchange(ViewLists& other);
  /// No lists so far are to be used again, those put aside neither.
  void forget() { ++now_; }

  /// Records the steps 0 to `count` - 1, each of which records one view and what is made of it, and submits
  /// them together. Where a view had more instances than there is room for, nothing was changed from its step
  /// on: then makes room, and records and submits those steps again, until all are done.
  void submit(gpu::Recorder& recorder, std::size_t count,
              const std::function<void(std::size_t)>& record_step);

  /// Numbers of the last submitted view.
  glsl::RenderStatus read_status() const;

  const TileShape& shape() const { return shape_; }
  uint32_t tiles_x(const ImageSize& size) const { return (size.width + shape_.width - 1) / shape_.width; }
  uint32_t tiles_y(const ImageSize& size) const { return (size.height + shape_.height - 1) / shape_.height; }

  /// The indirect arguments to dispatch passes over the visible Gaussians with.
  static constexpr uint32_t kVisibleArgs = 0;

  gpu::Array<glsl::Splat> splats;         ///< per Gaussian of the map
  gpu::Array<glsl::RenderStatus> status;  ///< 1
  uint32_t instance_capacity() const { return instance_capacity_; }

 private:
  /// After a submission: makes room if a view had more instances than that, and returns how many of the
  /// recorded views came before it.
  uint32_t settle();
  void reserve_instances(uint32_t capacity);
  void reserve(gpu::Recorder& recorder, const GaussianMap& map, const ImageSize& size);
  void record_projection(gpu::Recorder& recorder, const GaussianMap& map,
                         const gpu::Array<glsl::CameraState>& camera, float uncertainty_above);
  void record_instances(gpu::Recorder& recorder, const gpu::Array<glsl::CameraState>& camera, uint32_t tiles);
  gpu::Pass<passes::project_splats>& projection(const GaussianMap& map, bool listed);
  passes::project_splats::Bindings projection_of(const GaussianMap& map,
                                                 const gpu::Array<glsl::CameraState>& camera);

  /// Steps of mapping on one view that share lists, at most (docs/experiments.md).
  static constexpr int kUses = 4;

  gpu::Device& device_;
  TileShape shape_;
  uint32_t instance_capacity_ = 0;
  uint32_t gaussians_ = 0;
  uint64_t now_ = 1;  ///< grows when lists are forgotten

  /// Per SH degree, depth model, and whether the Gaussians are those of the lists; made when first needed.
  std::unique_ptr<gpu::Pass<passes::project_splats>> project_[4][2][2];
  gpu::Pass<passes::compact_visible> compact_;
  gpu::Pass<passes::gather_tile_counts> gather_;
  gpu::Pass<passes::emit_instances> emit_;
  gpu::Pass<passes::find_tile_ranges> ranges_;
  gpu::Pass<passes::prepare_dispatch> prepare_;
  ExclusiveScan scan_;
  RadixSort sort_;

  gpu::Array<glsl::uint> visible_flags_;
  gpu::Array<glsl::uint> visible_offsets_;
  gpu::Array<glsl::uint> depth_keys_;
  gpu::Array<glsl::uint> depth_order_;     ///< the visible Gaussians, near to far
  gpu::Array<glsl::uint> sorted_counts_;   ///< in that order: numbers of instances
  gpu::Array<glsl::uint> sorted_offsets_;  ///< in that order: where the instances are written
  gpu::Array<glsl::uint> instance_total_;
  gpu::Array<glsl::uint> instance_count_;
  gpu::Array<glsl::uint> tile_keys_;
  gpu::Array<glsl::uint> instance_owners_;  ///< per instance, by name: its Gaussian's index in the map
};

}  // namespace surefield
