#pragma once

#include "engine/gpu/device.h"

namespace surefield {

/// What a device computes and moves when nothing else is in the way: tells a busy machine from a slow kernel.
struct PeakRates {
  double gflops = 0;  ///< multiply-adds, each counted as two operations
  double exponentials_per_ns = 0;
  double copy_gb_per_s = 0;  ///< by the device's copy command; bytes copied, each read and written once
  double kernel_copy_gb_per_s = 0;  ///< by a kernel, 16 bytes an invocation
};

/// The best of several measurements.
PeakRates measure_peak(gpu::Device& device);

}  // namespace surefield
