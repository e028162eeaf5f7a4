#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>

#include "engine/sources/frame_source.h"

namespace surefield {

/// Counts frames as they arrive. May be used by any thread.
class ArrivalCount {
 public:
  void add(std::chrono::steady_clock::time_point arrived) {
    const std::lock_guard lock(mutex_);
    if (arrived_++ == 0) first_ = arrived;
    last_ = arrived;
  }

  LiveCounts counts(uint64_t dropped) const {
    const std::lock_guard lock(mutex_);
    return {arrived_, dropped, std::chrono::duration<double>(last_ - first_).count()};
  }

 private:
  mutable std::mutex mutex_;
  uint64_t arrived_ = 0;
  std::chrono::steady_clock::time_point first_{}, last_{};
};

}  // namespace surefield
