#pragma once

#include "engine/gpu/recorder.h"
#include "engine/primitives/device_count.h"
#include "shaders/shared/sort_histogram.h"
#include "shaders/shared/sort_offsets.h"
#include "shaders/shared/sort_scatter.h"

namespace surefield {

/// A stable radix sort of pairs of unsigned integers. One object serves one recorder at a time.
class RadixSort {
 public:
  explicit RadixSort(gpu::Device& device);

  /// Records the sort of the first `count` pairs by the lowest `bits` (0 to 32) bits of their keys,
  /// ascending, in place.
  void record(gpu::Recorder& recorder, const gpu::Array<glsl::uint>& keys,
              const gpu::Array<glsl::uint>& values, const DeviceCount& count, uint32_t bits);

 private:
  struct Pairs {
    const gpu::Array<glsl::uint>& keys;
    const gpu::Array<glsl::uint>& values;
  };
  void record_digit(gpu::Recorder& recorder, const Pairs& from, const Pairs& to, const DeviceCount& count,
                    uint32_t columns, uint32_t shift, uint32_t digit_bits);
  uint32_t columns_for(uint32_t capacity) const;

  bool is_cpu_;
  gpu::Pass<passes::sort_histogram> histogram_;
  gpu::Pass<passes::sort_offsets> offsets_;
  gpu::Pass<passes::sort_scatter> scatter_;
  gpu::Array<glsl::uint> table_;  ///< a row per digit, a column per invocation
  gpu::Array<glsl::uint> digit_totals_;
  gpu::Array<glsl::uint> other_keys_;
  gpu::Array<glsl::uint> other_values_;
};

}  // namespace surefield
