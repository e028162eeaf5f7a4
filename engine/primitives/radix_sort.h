#pragma once

#include "engine/gpu/recorder.h"
#include "engine/primitives/device_count.h"
#include "shaders/shared/sort_histogram.h"
#include "shaders/shared/sort_offsets.h"
#include "shaders/shared/sort_scatter.h"

namespace surefield {

/// How a radix sort is spread over a device. The result does not depend on it.
struct SortShape {
  uint32_t
      group_size;  ///< invocations of a workgroup that moves pairs; 256 counters each must fit shared memory
  uint32_t columns;      ///< invocations that move pairs, for large inputs
  uint32_t chunk_least;  ///< pairs that are worth an invocation
  uint32_t
      offsets_team;  ///< invocations that sum one row of the table of counters: a power of two, at most 256

  /// A software device wants few invocations, each with a long chunk of the input; a GPU wants many.
  static SortShape for_device(const gpu::DeviceLimits& limits);
};

/// A stable radix sort of pairs of unsigned integers, digit by digit from the lowest. One object serves one
/// recorder at a time.
class RadixSort {
 public:
  explicit RadixSort(gpu::Device& device);
  RadixSort(gpu::Device& device, const SortShape& shape);

  /// Records the sort of the first `count` pairs by the lowest `bits` (0 to 32) bits of their keys,
  /// ascending. What lies behind them is undefined afterwards: after an odd number of digits, `keys` and
  /// `values` have exchanged their memory with the sort's own arrays.
  void record(gpu::Recorder& recorder, gpu::Array<glsl::uint>& keys, gpu::Array<glsl::uint>& values,
              const DeviceCount& count, uint32_t bits);

 private:
  struct Pairs {
    const gpu::Array<glsl::uint>& keys;
    const gpu::Array<glsl::uint>& values;
  };
  struct Digit {
    uint32_t shift, bits;
  };
  uint32_t columns_for(uint32_t capacity) const;
  void record_digit(gpu::Recorder& recorder, const Pairs& from, const Pairs& to, const DeviceCount& count,
                    const Digit& digit);

  SortShape shape_;
  gpu::Pass<passes::sort_histogram> histogram_;
  gpu::Pass<passes::sort_offsets> offsets_;
  gpu::Pass<passes::sort_scatter> scatter_;
  gpu::Array<glsl::uint> table_;  ///< counters: a row per digit, a column per invocation that moves pairs
  gpu::Array<glsl::uint> digit_totals_;
  gpu::Array<glsl::uint> other_keys_;
  gpu::Array<glsl::uint> other_values_;
};

}  // namespace surefield
