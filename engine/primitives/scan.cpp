#include "engine/primitives/scan.h"

#include <algorithm>

namespace surefield {

namespace {

/// Elements that are worth an invocation, and that one may loop over twice (lavapipe ends loops at 65535
/// rounds in all).
constexpr uint32_t kScanChunkLeast = 8, kScanChunkMax = 16384;

}  // namespace

ScanShape ScanShape::for_device(const gpu::DeviceLimits& limits) {
  if (limits.is_cpu) return {.group_size = 16, .groups = 8};
  return {.group_size = 256, .groups = 1024};
}

ExclusiveScan::ExclusiveScan(gpu::Device& device)
    : ExclusiveScan(device, ScanShape::for_device(device.limits())) {}

ExclusiveScan::ExclusiveScan(gpu::Device& device, const ScanShape& shape)
    : shape_(shape),
      sums_(device, shape.group_size),
      apply_(device, shape.group_size),
      group_sums_(device, "sums of scan groups") {}

void ExclusiveScan::record(gpu::Recorder& recorder, const gpu::Array<glsl::uint>& input,
                           const gpu::Array<glsl::uint>& output, const gpu::Array<glsl::uint>& total,
                           const DeviceCount& count) {
  require_room(count, {&input.buffer(), &output.buffer()});
  const uint32_t wanted = std::min(count.capacity / (kScanChunkLeast * shape_.group_size) + 1, shape_.groups);
  const uint32_t needed = count.capacity / (kScanChunkMax * shape_.group_size) + 1;
  const uint32_t groups = std::max(wanted, needed);
  recorder.reserve(group_sums_, groups);
  recorder.dispatch(sums_, groups, {.count = count.value, .values = input, .group_sums = group_sums_},
                    {.capacity = count.capacity});
  recorder.dispatch(apply_, groups,
                    {.count = count.value,
                     .values = input,
                     .group_sums = group_sums_,
                     .prefix_sums = output,
                     .total = total},
                    {.capacity = count.capacity});
}

}  // namespace surefield
