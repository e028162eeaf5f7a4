#pragma once

#include "engine/gpu/recorder.h"
#include "engine/primitives/device_count.h"
#include "shaders/shared/reduce_chunks.h"
#include "shaders/shared/reduce_total.h"

namespace surefield {

/// Sums of floats in a fixed order. One object serves one recorder at a time.
class Reduce {
 public:
  explicit Reduce(gpu::Device& device);

  /// Records result[0] = values[0] + ... + values[count - 1]. The order of the additions depends on the count
  /// alone, so that the same values give the same bits on every run, whatever the capacity.
  void sum(gpu::Recorder& recorder, const gpu::Array<float>& values, const gpu::Array<float>& result,
           const DeviceCount& count);

 private:
  gpu::Pass<passes::reduce_chunks> chunks_;
  gpu::Pass<passes::reduce_total> total_;
  gpu::Array<float> partial_sums_;
};

}  // namespace surefield
