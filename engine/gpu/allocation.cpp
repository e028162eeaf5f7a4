#include "engine/gpu/allocation.h"

#include <fmt/format.h>

#include "engine/gpu/error.h"

namespace surefield::gpu {

namespace {

constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                      VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;

}  // namespace

Allocation allocate(Device& device, uint64_t bytes, const MemoryKind& kind, const std::string& name) {
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = bytes;
  info.usage = kUsage;
  Allocation allocation;
  const std::string doing = fmt::format("allocating {} ({:.1f} MB)", name, static_cast<double>(bytes) / 1e6);
  check(vkCreateBuffer(device.handle(), &info, nullptr, &allocation.buffer), doing.c_str());
  ++device.live_counters().objects;
  try {
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device.handle(), allocation.buffer, &needs);
    VkMemoryAllocateInfo memory{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    memory.allocationSize = needs.size;
    memory.memoryTypeIndex = device.memory_type(needs.memoryTypeBits, kind.required, kind.preferred);
    check(vkAllocateMemory(device.handle(), &memory, nullptr, &allocation.memory), doing.c_str());
    ++device.live_counters().allocations;
    check(vkBindBufferMemory(device.handle(), allocation.buffer, allocation.memory, 0), doing.c_str());
  } catch (...) {
    free_allocation(device, allocation);
    throw;
  }
  return allocation;
}

void free_allocation(Device& device, Allocation& allocation) {
  if (allocation.buffer) vkDestroyBuffer(device.handle(), allocation.buffer, nullptr);
  if (allocation.memory) vkFreeMemory(device.handle(), allocation.memory, nullptr);
  allocation = {};
}

}  // namespace surefield::gpu
