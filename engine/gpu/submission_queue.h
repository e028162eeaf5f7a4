#pragma once

#include <vulkan/vulkan.h>

#include <atomic>
#include <cstdint>
#include <span>

#include "engine/gpu/live_counters.h"

namespace surefield::gpu {

/// A queue whose submissions have numbers, 1, 2, 3, ..., in the order in which they start; the device tells
/// by a timeline semaphore which have finished. submit() and what else uses the queue must be kept apart; the
/// other methods may be called by any thread at any time.
class SubmissionQueue {
 public:
  SubmissionQueue(VkDevice device, VkQueue queue, LiveCounters& counters);
  ~SubmissionQueue();
  SubmissionQueue(const SubmissionQueue&) = delete;

  /// Submits command buffers, to run in this order; returns the number of the submission. Throws Error.
  uint64_t submit(std::span<const VkCommandBuffer> commands);
  /// Whether this submission and all before it have finished. Throws Error where the device was lost.
  bool has_finished(uint64_t submission);
  /// Waits until they have. Throws Error where the device was lost.
  void wait(uint64_t submission);

 private:
  void note_finished(uint64_t submission);

  VkDevice device_;
  VkQueue queue_;
  LiveCounters& counters_;
  VkSemaphore timeline_ = VK_NULL_HANDLE;
  uint64_t submitted_ = 0;
  std::atomic<uint64_t> finished_{0};  ///< at least so many, so that what is known is not asked for again
};

}  // namespace surefield::gpu
