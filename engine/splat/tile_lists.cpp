#include "engine/splat/tile_lists.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "engine/gpu/error.h"

namespace surefield {

namespace {

constexpr uint32_t kInstanceArgs = 1;
constexpr uint32_t kInstanceWorkgroup = 256;  // large, since there may be millions of instances
constexpr uint32_t kFirstInstanceCapacity = 1u << 16;

passes::emit_instances::Constants tile_constants(const TileShape& shape) {
  return {.TILE_W = shape.width, .TILE_H = shape.height};
}

}  // namespace

TileShape TileShape::for_device(const gpu::Device& device) {
  return {.width = 8, .height = 8, .lanes = device.limits().subgroup_size};
}

ViewLists::ViewLists(gpu::Device& device)
    : dispatch_args(device, "dispatch arguments", 2),
      visible_count(device, "visible count"),
      visible_ids(device, "visible Gaussians"),
      tile_counts(device, "tile counts"),
      instance_offsets(device, "instance offsets"),
      instances(device, "instances"),
      tile_gaussians(device, "Gaussians of tiles"),
      tile_ranges(device, "tile ranges") {}

TileLists::TileLists(gpu::Device& device, const TileShape& shape)
    : ViewLists(device),
      splats(device, "splats"),
      status(device, "render status"),
      device_(device),
      shape_(shape),
      compact_(device, gpu::kWorkgroup),
      gather_(device, gpu::kWorkgroup),
      emit_(device, gpu::kWorkgroup, tile_constants(shape)),
      ranges_(device, kInstanceWorkgroup),
      prepare_(device, device.limits().subgroup_size),
      scan_(device),
      sort_(device),
      visible_flags_(device, "visible flags"),
      visible_offsets_(device, "visible offsets"),
      depth_keys_(device, "depth keys"),
      depth_order_(device, "Gaussians by depth"),
      sorted_counts_(device, "tile counts by depth"),
      sorted_offsets_(device, "instance offsets by depth"),
      instance_total_(device, "instance total"),
      instance_count_(device, "instance count"),
      tile_keys_(device, "tile keys"),
      instance_owners_(device, "instance owners") {
  reserve_instances(kFirstInstanceCapacity);
  status.upload(std::vector<glsl::RenderStatus>{{}});
}

gpu::Pass<passes::project_splats>& TileLists::projection(const GaussianMap& map, bool listed) {
  const bool plane = map.depth_model() == DepthModel::Plane;
  auto& pass = project_[map.sh_degree()][plane][listed];
  if (!pass)
    pass = std::make_unique<gpu::Pass<passes::project_splats>>(
        device_, gpu::kWorkgroup,
        passes::project_splats::Constants{shape_.width, shape_.height, static_cast<uint32_t>(map.sh_degree()),
                                          plane ? 1u : 0u, listed ? 1u : 0u});
  return *pass;
}

void TileLists::reserve_instances(uint32_t capacity) {
  const uint64_t most = static_cast<uint64_t>(device_.limits().workgroups_x) * kInstanceWorkgroup;
  if (capacity > most)
    throw gpu::Error(
        gpu::Error::Kind::Limit,
        "the view needs more (Gaussian, tile) pairs than the device can dispatch: use a smaller image");
  instance_capacity_ = std::max(instance_capacity_, capacity);
  instance_owners_.reserve(instance_capacity_);
  tile_keys_.reserve(instance_capacity_);
}

void TileLists::reserve(gpu::Recorder& recorder, const GaussianMap& map, const ImageSize& size) {
  gaussians_ = map.size();
  recorder.reserve(splats, gaussians_);
  recorder.reserve(tile_counts, gaussians_);
  recorder.reserve(instance_offsets, gaussians_);
  recorder.reserve(visible_flags_, gaussians_);
  recorder.reserve(visible_offsets_, gaussians_);
  recorder.reserve(depth_keys_, gaussians_);
  recorder.reserve(visible_ids, gaussians_);
  recorder.reserve(depth_order_, gaussians_);
  recorder.reserve(sorted_counts_, gaussians_);
  recorder.reserve(sorted_offsets_, gaussians_);
  // Those that were put aside may be from before there was room for so many.
  recorder.reserve(instances, instance_capacity_);
  recorder.reserve(tile_gaussians, instance_capacity_);
  recorder.reserve(tile_ranges, static_cast<uint64_t>(tiles_x(size)) * tiles_y(size));
}

void TileLists::record(gpu::Recorder& recorder, const GaussianMap& map,
                       const gpu::Array<glsl::CameraState>& camera, const ImageSize& size,
                       float uncertainty_above) {
  reserve(recorder, map, size);
  record_projection(recorder, map, camera, uncertainty_above);
  record_instances(recorder, camera, tiles_x(size) * tiles_y(size));
  camera_ = &camera;
  age_ = now_;
  uses_ = 1;
}

void TileLists::exchange(ViewLists& other) {
  dispatch_args.exchange_memory(other.dispatch_args);
  visible_count.exchange_memory(other.visible_count);
  visible_ids.exchange_memory(other.visible_ids);
  tile_counts.exchange_memory(other.tile_counts);
  instance_offsets.exchange_memory(other.instance_offsets);
  instances.exchange_memory(other.instances);
  tile_gaussians.exchange_memory(other.tile_gaussians);
  tile_ranges.exchange_memory(other.tile_ranges);
  std::swap(camera_, other.camera_);
  std::swap(uses_, other.uses_);
  std::swap(age_, other.age_);
}

void TileLists::record_again(gpu::Recorder& recorder, const GaussianMap& map,
                             const gpu::Array<glsl::CameraState>& camera, float uncertainty_above) {
  recorder.dispatch_indirect(projection(map, true), dispatch_args, kVisibleArgs, projection_of(map, camera),
                             {.count = gaussians_, .uncertainty_above = uncertainty_above});
  ++uses_;
}

passes::project_splats::Bindings TileLists::projection_of(const GaussianMap& map,
                                                          const gpu::Array<glsl::CameraState>& camera) {
  return {.camera = camera,
          .means = map.means.value,
          .log_scales = map.log_scales.value,
          .rotations = map.rotations.value,
          .opacity_logits = map.opacity_logits.value,
          .sh = map.sh.value,
          .splats = splats,
          .tile_counts = tile_counts,
          .visible_flags = visible_flags_,
          .uncertainty = map.uncertainty,
          .visible_count = visible_count,
          .visible_ids = visible_ids,
          .status = status,
          .sampling = map.sampling};
}

void TileLists::record_projection(gpu::Recorder& recorder, const GaussianMap& map,
                                  const gpu::Array<glsl::CameraState>& camera, float uncertainty_above) {
  auto& project = projection(map, false);
  recorder.dispatch(project, project.groups(gaussians_), projection_of(map, camera),
                    {.count = gaussians_, .uncertainty_above = uncertainty_above});
  scan_.record(recorder, visible_flags_, visible_offsets_, visible_count, {map.count, gaussians_});
  scan_.record(recorder, tile_counts, instance_offsets, instance_total_, {map.count, gaussians_});
  recorder.dispatch(compact_, compact_.groups(gaussians_),
                    {.splats = splats,
                     .visible_flags = visible_flags_,
                     .visible_offsets = visible_offsets_,
                     .depth_keys = depth_keys_,
                     .visible_ids = visible_ids,
                     .depth_order = depth_order_},
                    {.count = gaussians_});
  sort_.record(recorder, depth_keys_, depth_order_, {visible_count, gaussians_}, glsl::DEPTH_KEY_BITS);
  recorder.dispatch(prepare_, 1, {.element_count = visible_count, .dispatch_args = dispatch_args},
                    {.workgroup_size = gpu::kWorkgroup, .slot = kVisibleArgs});
}

void TileLists::record_instances(gpu::Recorder& recorder, const gpu::Array<glsl::CameraState>& camera,
                                 uint32_t tiles) {
  recorder.dispatch_indirect(gather_, dispatch_args, kVisibleArgs,
                             {.visible_count = visible_count,
                              .depth_order = depth_order_,
                              .tile_counts = tile_counts,
                              .sorted_counts = sorted_counts_},
                             {});
  scan_.record(recorder, sorted_counts_, sorted_offsets_, instance_total_, {visible_count, gaussians_});
  recorder.dispatch_indirect(emit_, dispatch_args, kVisibleArgs,
                             {.camera = camera,
                              .splats = splats,
                              .visible_count = visible_count,
                              .depth_order = depth_order_,
                              .sorted_offsets = sorted_offsets_,
                              .instance_total = instance_total_,
                              .tile_keys = tile_keys_,
                              .instances = instances,
                              .instance_owners = instance_owners_,
                              .status = status,
                              .instance_count = instance_count_,
                              .sorted_counts = sorted_counts_,
                              .instance_offsets = instance_offsets},
                             {.capacity = instance_capacity_});
  const auto bits = static_cast<uint32_t>(std::bit_width(tiles - 1));
  sort_.record(recorder, tile_keys_, instances, {instance_count_, instance_capacity_}, bits);
  recorder.fill(tile_ranges, tiles, 0);
  recorder.dispatch(prepare_, 1, {.element_count = instance_count_, .dispatch_args = dispatch_args},
                    {.workgroup_size = kInstanceWorkgroup, .slot = kInstanceArgs});
  recorder.dispatch_indirect(ranges_, dispatch_args, kInstanceArgs,
                             {.instance_count = instance_count_,
                              .tile_keys = tile_keys_,
                              .instances = instances,
                              .instance_owners = instance_owners_,
                              .tile_ranges = tile_ranges,
                              .tile_gaussians = tile_gaussians},
                             {});
}

glsl::RenderStatus TileLists::read_status() const {
  return status.download(1)[0];
}

void TileLists::submit(gpu::Recorder& recorder, std::size_t count,
                       const std::function<void(std::size_t)>& record_step) {
  for (std::size_t done = 0; done < count; done += settle()) {
    for (std::size_t step = done; step < count; ++step) record_step(step);
    recorder.submit();
  }
}

uint32_t TileLists::settle() {
  const glsl::RenderStatus now = read_status();
  if (now.overflow) {
    reserve_instances(now.needed + now.needed / 4);
    forget();
  }
  status.upload(std::vector<glsl::RenderStatus>{{.visible = now.visible, .instances = now.instances}});
  return now.completed;
}

}  // namespace surefield
