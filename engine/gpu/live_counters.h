#pragma once

#include <atomic>

#include "engine/gpu/device_counters.h"

namespace surefield::gpu {

/// DeviceCounters while any number of threads count.
struct LiveCounters {
  std::atomic<uint64_t> submissions{0};
  std::atomic<uint64_t> allocations{0};
  std::atomic<uint64_t> objects{0};
  std::atomic<uint64_t> bytes_uploaded{0};
  std::atomic<uint64_t> bytes_read_back{0};

  DeviceCounters read() const { return {submissions, allocations, objects, bytes_uploaded, bytes_read_back}; }
};

}  // namespace surefield::gpu
