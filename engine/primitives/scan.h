#pragma once

#include "engine/gpu/recorder.h"
#include "engine/primitives/device_count.h"
#include "shaders/shared/scan_apply.h"
#include "shaders/shared/scan_sums.h"

namespace surefield {

/// Exclusive prefix sums of unsigned integers. One object serves one recorder at a time.
class ExclusiveScan {
 public:
  explicit ExclusiveScan(gpu::Device& device);

  /// Records output[i] = input[0] + ... + input[i - 1] for i < count, and total[0] = the sum of all, modulo
  /// 2^32. `input` and `output` must be different arrays.
  void record(gpu::Recorder& recorder, const gpu::Array<glsl::uint>& input,
              const gpu::Array<glsl::uint>& output, const gpu::Array<glsl::uint>& total,
              const DeviceCount& count);

 private:
  uint32_t groups_max_;
  gpu::Pass<passes::scan_sums> sums_;
  gpu::Pass<passes::scan_apply> apply_;
  gpu::Array<glsl::uint> group_sums_;
};

}  // namespace surefield
