#pragma once

#include "engine/gpu/recorder.h"
#include "engine/primitives/device_count.h"
#include "shaders/shared/scan_apply.h"
#include "shaders/shared/scan_sums.h"

namespace surefield {

/// How a scan is spread over a device. The result does not depend on it.
struct ScanShape {
  uint32_t group_size;  ///< invocations of a workgroup: a power of two
  uint32_t groups;      ///< workgroups, for large inputs

  /// A software device wants few invocations, each with a long chunk of the input; a GPU wants many.
  static ScanShape for_device(const gpu::DeviceLimits& limits);
};

/// Exclusive prefix sums of unsigned integers. One object serves one recorder at a time.
class ExclusiveScan {
 public:
  explicit ExclusiveScan(gpu::Device& device);
  ExclusiveScan(gpu::Device& device, const ScanShape& shape);

  /// Records output[i] = input[0] + ... + input[i - 1] for i < count, and total[0] = the sum of all, modulo
  /// 2^32. `input` and `output` must be different arrays.
  void record(gpu::Recorder& recorder, const gpu::Array<glsl::uint>& input,
              const gpu::Array<glsl::uint>& output, const gpu::Array<glsl::uint>& total,
              const DeviceCount& count);

 private:
  ScanShape shape_;
  gpu::Pass<passes::scan_sums> sums_;
  gpu::Pass<passes::scan_apply> apply_;
  gpu::Array<glsl::uint> group_sums_;
};

}  // namespace surefield
