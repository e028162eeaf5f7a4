#include "engine/primitives/radix_sort.h"

#include <algorithm>

namespace surefield {

namespace {

/// Invocations of a workgroup that moves pairs: 256 counters of each fill 32 KiB of shared memory.
constexpr uint32_t kGroupSize = 32;
/// Most columns of the table, and the least number of pairs for which a column pays. A software device wants
/// few, a GPU many.
constexpr uint32_t kCpuColumns = 128, kCpuChunkLeast = 128;
constexpr uint32_t kGpuColumns = 8192, kGpuChunkLeast = 32;
/// Pairs that one invocation may loop over (lavapipe ends loops at 65535 rounds in all).
constexpr uint32_t kChunkMax = 32768;

constexpr uint32_t kDigitBitsMax = 8;

}  // namespace

RadixSort::RadixSort(gpu::Device& device)
    : is_cpu_(device.limits().is_cpu),
      histogram_(device, kGroupSize, {.CHUNK_LEAST = is_cpu_ ? kCpuChunkLeast : kGpuChunkLeast}),
      offsets_(device, is_cpu_ ? 16 : 256, {.CHUNK_LEAST = is_cpu_ ? kCpuChunkLeast : kGpuChunkLeast}),
      scatter_(device, kGroupSize, {.CHUNK_LEAST = is_cpu_ ? kCpuChunkLeast : kGpuChunkLeast}),
      table_(device, "digit table of the sort"),
      digit_totals_(device, "digit totals of the sort", glsl::SORT_DIGITS_MAX),
      other_keys_(device, "other keys of the sort"),
      other_values_(device, "other values of the sort") {}

uint32_t RadixSort::columns_for(uint32_t capacity) const {
  const uint32_t least = is_cpu_ ? kCpuChunkLeast : kGpuChunkLeast;
  const uint32_t wanted = std::min(capacity / least + 1, is_cpu_ ? kCpuColumns : kGpuColumns);
  const uint32_t needed = capacity / kChunkMax + 1;
  return histogram_.groups(std::max(wanted, needed)) * kGroupSize;
}

void RadixSort::record(gpu::Recorder& recorder, const gpu::Array<glsl::uint>& keys,
                       const gpu::Array<glsl::uint>& values, const DeviceCount& count, uint32_t bits) {
  const uint32_t columns = columns_for(count.capacity);
  recorder.reserve(table_, uint64_t{columns} * glsl::SORT_DIGITS_MAX);
  recorder.reserve(other_keys_, count.capacity);
  recorder.reserve(other_values_, count.capacity);
  // An even number of passes, so that the result ends where it began.
  const uint32_t passes = (bits + 2 * kDigitBitsMax - 1) / (2 * kDigitBitsMax) * 2;
  const Pairs given{keys, values}, other{other_keys_, other_values_};
  for (uint32_t p = 0, shift = 0; p < passes; ++p) {
    const uint32_t digit_bits = (bits - shift + (passes - p) - 1) / (passes - p);
    record_digit(recorder, p % 2 ? other : given, p % 2 ? given : other, count, columns, shift, digit_bits);
    shift += digit_bits;
  }
}

void RadixSort::record_digit(gpu::Recorder& recorder, const Pairs& from, const Pairs& to,
                             const DeviceCount& count, uint32_t columns, uint32_t shift,
                             uint32_t digit_bits) {
  recorder.dispatch(
      histogram_, columns / kGroupSize, {.count = count.value, .keys = from.keys, .table = table_},
      {.capacity = count.capacity, .columns = columns, .shift = shift, .digit_bits = digit_bits});
  recorder.dispatch(offsets_, 1u << digit_bits,
                    {.count = count.value, .table = table_, .digit_totals = digit_totals_},
                    {.capacity = count.capacity, .columns = columns});
  recorder.dispatch(
      scatter_, columns / kGroupSize,
      {.count = count.value,
       .keys = from.keys,
       .values = from.values,
       .table = table_,
       .digit_totals = digit_totals_,
       .sorted_keys = to.keys,
       .sorted_values = to.values},
      {.capacity = count.capacity, .columns = columns, .shift = shift, .digit_bits = digit_bits});
}

}  // namespace surefield
