#include "engine/gpu/recording_pool.h"

#include "engine/gpu/error.h"

namespace surefield::gpu {

namespace {

constexpr uint32_t kSetsPerPool = 256;

}  // namespace

RecordingPool::RecordingPool(VkDevice device, uint32_t queue_family, LiveCounters& counters)
    : device_(device), queue_family_(queue_family), counters_(counters) {}

RecordingPool::~RecordingPool() {
  for (const auto& objects : all_) {
    vkDestroyQueryPool(device_, objects->queries, nullptr);
    for (VkDescriptorPool pool : objects->descriptor_pools) vkDestroyDescriptorPool(device_, pool, nullptr);
    vkDestroyCommandPool(device_, objects->pool, nullptr);
  }
}

RecordingObjects& RecordingPool::take() {
  std::lock_guard lock(mutex_);
  if (!free_.empty()) {
    RecordingObjects& objects = *free_.back();
    reset(objects);
    free_.pop_back();
    return objects;
  }
  RecordingObjects& objects = *all_.emplace_back(std::make_unique<RecordingObjects>());
  VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool.queueFamilyIndex = queue_family_;
  check(vkCreateCommandPool(device_, &pool, nullptr, &objects.pool), "creating a command pool");
  ++counters_.objects;
  VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  info.commandPool = objects.pool;
  info.commandBufferCount = 1;
  check(vkAllocateCommandBuffers(device_, &info, &objects.commands), "allocating a command buffer");
  return objects;
}

void RecordingPool::give_back(RecordingObjects& objects) {
  std::lock_guard lock(mutex_);
  free_.push_back(&objects);
}

void RecordingPool::reset(RecordingObjects& objects) const {
  for (VkDescriptorPool pool : objects.descriptor_pools) vkResetDescriptorPool(device_, pool, 0);
  check(vkResetCommandPool(device_, objects.pool, 0), "resetting a command pool");
}

VkDescriptorPool RecordingPool::add_descriptor_pool(RecordingObjects& objects) {
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kSetsPerPool * 16};
  VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  info.maxSets = kSetsPerPool;
  info.poolSizeCount = 1;
  info.pPoolSizes = &size;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  check(vkCreateDescriptorPool(device_, &info, nullptr, &pool), "creating a descriptor pool");
  ++counters_.objects;
  objects.descriptor_pools.push_back(pool);
  return pool;
}

void RecordingPool::reserve_queries(RecordingObjects& objects, uint32_t count) {
  if (objects.query_count >= count) return;
  VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = count;
  VkQueryPool queries = VK_NULL_HANDLE;
  check(vkCreateQueryPool(device_, &info, nullptr, &queries), "creating a query pool");
  ++counters_.objects;
  vkDestroyQueryPool(device_, objects.queries, nullptr);
  objects.queries = queries;
  objects.query_count = count;
}

}  // namespace surefield::gpu
