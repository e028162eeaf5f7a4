#pragma once

#include <cstdint>

namespace surefield::gpu {

/// What a device was asked to do since it was opened: what tells a frame that reuses everything from one that
/// allocates and waits.
struct DeviceCounters {
  uint64_t submissions = 0;      ///< to the queue, of one or more command buffers each
  uint64_t allocations = 0;      ///< of device or staging memory
  uint64_t objects = 0;          ///< buffers, command, descriptor and query pools, and semaphores created
  uint64_t bytes_uploaded = 0;   ///< from host memory into buffers
  uint64_t bytes_read_back = 0;  ///< from buffers into host memory

  /// What was counted since `before`.
  DeviceCounters operator-(const DeviceCounters& before) const {
    return {submissions - before.submissions, allocations - before.allocations, objects - before.objects,
            bytes_uploaded - before.bytes_uploaded, bytes_read_back - before.bytes_read_back};
  }
};

}  // namespace surefield::gpu
