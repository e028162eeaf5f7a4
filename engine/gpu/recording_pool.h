#pragma once

#include <vulkan/vulkan.h>

#include <memory>
#include <mutex>
#include <vector>

#include "engine/gpu/live_counters.h"

namespace surefield::gpu {

/// The Vulkan objects that commands are recorded with.
struct RecordingObjects {
  VkCommandPool pool = VK_NULL_HANDLE;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  std::vector<VkDescriptorPool> descriptor_pools;  ///< where there are no push descriptors
  VkQueryPool queries = VK_NULL_HANDLE;            ///< where timestamps were asked for once
  uint32_t query_count = 0;
};

/// The recording objects of a device. Recorders come and go; what they record with is lent to them and used
/// again, so that there is as much of it as there were recorders at one time. May be used by several threads.
class RecordingPool {
 public:
  RecordingPool(VkDevice device, uint32_t queue_family, LiveCounters& counters);
  ~RecordingPool();
  RecordingPool(const RecordingPool&) = delete;

  /// Lends objects, with nothing recorded. Throws Error.
  RecordingObjects& take();
  /// Takes them back; the device must have finished what was submitted.
  void give_back(RecordingObjects& objects);
  /// Makes them record anew. Throws Error.
  void reset(RecordingObjects& objects) const;

  /// Adds a descriptor pool to lent objects. Throws Error.
  VkDescriptorPool add_descriptor_pool(RecordingObjects& objects);
  /// Sees to it that lent objects, with nothing submitted, have so many queries. Throws Error.
  void reserve_queries(RecordingObjects& objects, uint32_t count);

 private:
  VkDevice device_;
  uint32_t queue_family_;
  LiveCounters& counters_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<RecordingObjects>> all_;
  std::vector<RecordingObjects*> free_;
};

}  // namespace surefield::gpu
