#pragma once

#include <vulkan/vulkan.h>

namespace surefield::gpu {

/// Records a barrier: whatever was written before it is there for everything after it, in later submissions
/// too, and for the host once the submission has finished.
void record_full_barrier(VkCommandBuffer commands);

}  // namespace surefield::gpu
