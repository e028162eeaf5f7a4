#pragma once

#include <vulkan/vulkan.h>

#include "engine/types/error.h"

namespace surefield::gpu {

using Error = DeviceError;

/// Throws the Error that fits `result` unless it is VK_SUCCESS; `doing` completes "... while <doing>".
void check(VkResult result, const char* doing);

}  // namespace surefield::gpu
