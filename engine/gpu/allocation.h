#pragma once

#include <string>

#include "engine/gpu/device.h"

namespace surefield::gpu {

/// A buffer and the memory that it has to itself.
struct Allocation {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
};

/// Of what kind memory must be, and should be where the device has it so.
struct MemoryKind {
  VkMemoryPropertyFlags required = 0;
  VkMemoryPropertyFlags preferred = 0;
};

/// Makes a storage and transfer buffer of `bytes` in memory of that kind; `name` is what an error calls it.
/// Throws Error.
Allocation allocate(Device& device, uint64_t bytes, const MemoryKind& kind, const std::string& name);

/// Destroys both; the allocation is empty then.
void free_allocation(Device& device, Allocation& allocation);

}  // namespace surefield::gpu
