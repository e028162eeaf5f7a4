#include "engine/primitives/radix_sort.h"

#include <algorithm>

namespace surefield {

namespace {

constexpr uint32_t kDigitBitsMax = 8;
static_assert(glsl::SORT_DIGITS_MAX == 1u << kDigitBitsMax);
/// Pairs that one invocation may loop over (lavapipe ends loops at 65535 rounds in all).
constexpr uint32_t kSortChunkMax = 32768;
constexpr uint32_t kOffsetsGroupSize = 64;

}  // namespace

SortShape SortShape::for_device(const gpu::DeviceLimits& limits) {
  if (limits.is_cpu) return {.group_size = 16, .columns = 512, .chunk_least = 512, .offsets_team = 1};
  return {.group_size = 32, .columns = 8192, .chunk_least = 32, .offsets_team = 256};
}

RadixSort::RadixSort(gpu::Device& device) : RadixSort(device, SortShape::for_device(device.limits())) {}

RadixSort::RadixSort(gpu::Device& device, const SortShape& shape)
    : shape_(shape),
      histogram_(device, shape.group_size, {.CHUNK_LEAST = shape.chunk_least}),
      offsets_(device, std::max(kOffsetsGroupSize, shape.offsets_team),
               {.CHUNK_LEAST = shape.chunk_least, .TEAM = shape.offsets_team}),
      scatter_(device, shape.group_size, {.CHUNK_LEAST = shape.chunk_least}),
      table_(device, "digit table of the sort"),
      digit_totals_(device, "digit totals of the sort", glsl::SORT_DIGITS_MAX),
      other_keys_(device, "other keys of the sort"),
      other_values_(device, "other values of the sort") {}

uint32_t RadixSort::columns_for(uint32_t capacity) const {
  const uint32_t wanted = std::min(capacity / shape_.chunk_least + 1, shape_.columns);
  const uint32_t needed = capacity / kSortChunkMax + 1;
  return histogram_.groups(std::max(wanted, needed)) * shape_.group_size;
}

void RadixSort::record(gpu::Recorder& recorder, gpu::Array<glsl::uint>& keys, gpu::Array<glsl::uint>& values,
                       const DeviceCount& count, uint32_t bits) {
  require_room(count, {&keys.buffer(), &values.buffer()});
  recorder.reserve(table_, uint64_t{columns_for(count.capacity)} * glsl::SORT_DIGITS_MAX);
  recorder.reserve(other_keys_, count.capacity);
  recorder.reserve(other_values_, count.capacity);
  uint32_t shift = 0;
  for (uint32_t left = (bits + kDigitBitsMax - 1) / kDigitBitsMax; left > 0; --left) {
    const uint32_t digit_bits = (bits - shift + left - 1) / left;
    record_digit(recorder, {keys, values}, {other_keys_, other_values_}, count, {shift, digit_bits});
    keys.exchange_memory(other_keys_);
    values.exchange_memory(other_values_);
    shift += digit_bits;
  }
}

void RadixSort::record_digit(gpu::Recorder& recorder, const Pairs& from, const Pairs& to,
                             const DeviceCount& count, const Digit& digit) {
  const uint32_t columns = columns_for(count.capacity);
  const uint32_t digits = 1u << digit.bits;
  recorder.dispatch(
      histogram_, columns / shape_.group_size, {.count = count.value, .keys = from.keys, .table = table_},
      {.capacity = count.capacity, .columns = columns, .shift = digit.shift, .digit_bits = digit.bits});
  recorder.dispatch(offsets_, offsets_.groups(digits * shape_.offsets_team),
                    {.count = count.value, .table = table_, .digit_totals = digit_totals_},
                    {.capacity = count.capacity, .columns = columns, .digits = digits});
  recorder.dispatch(
      scatter_, columns / shape_.group_size,
      {.count = count.value,
       .keys = from.keys,
       .values = from.values,
       .table = table_,
       .digit_totals = digit_totals_,
       .sorted_keys = to.keys,
       .sorted_values = to.values},
      {.capacity = count.capacity, .columns = columns, .shift = digit.shift, .digit_bits = digit.bits});
}

}  // namespace surefield
