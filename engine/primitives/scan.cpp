#include "engine/primitives/scan.h"

#include <algorithm>

namespace surefield {

namespace {

/// A software device wants few invocations, each with a long chunk; a GPU wants many.
constexpr uint32_t kCpuGroupSize = 16, kCpuGroups = 8;
constexpr uint32_t kGpuGroupSize = 256, kGpuGroups = 1024;
/// Elements that are worth an invocation, and that one may loop over (lavapipe ends loops at 65535 rounds in
/// all).
constexpr uint32_t kChunkWanted = 8, kChunkMax = 16384;

}  // namespace

ExclusiveScan::ExclusiveScan(gpu::Device& device)
    : groups_max_(device.limits().is_cpu ? kCpuGroups : kGpuGroups),
      sums_(device, device.limits().is_cpu ? kCpuGroupSize : kGpuGroupSize),
      apply_(device, device.limits().is_cpu ? kCpuGroupSize : kGpuGroupSize),
      group_sums_(device, "sums of scan groups") {}

void ExclusiveScan::record(gpu::Recorder& recorder, const gpu::Array<glsl::uint>& input,
                           const gpu::Array<glsl::uint>& output, const gpu::Array<glsl::uint>& total,
                           const DeviceCount& count) {
  const uint32_t wanted = std::clamp(sums_.groups(count.capacity / kChunkWanted), 1u, groups_max_);
  const uint32_t groups = std::max(wanted, sums_.groups(count.capacity / kChunkMax));
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
