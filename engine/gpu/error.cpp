#include "engine/gpu/error.h"

#include <fmt/format.h>

namespace surefield::gpu {

void check(VkResult result, const char* doing) {
  switch (result) {
    case VK_SUCCESS:
      return;
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
      throw Error(
          Error::Kind::OutOfMemory,
          fmt::format("the device ran out of memory while {}: use a smaller --scale or another --device",
                      doing));
    case VK_ERROR_OUT_OF_HOST_MEMORY:
      throw Error(Error::Kind::OutOfMemory, fmt::format("the host ran out of memory while {}", doing));
    case VK_ERROR_DEVICE_LOST:
      throw Error(Error::Kind::DeviceLost,
                  fmt::format("the device was lost while {}: check the driver's log, or try another --device",
                              doing));
    default:
      throw Error(Error::Kind::Driver, fmt::format("the Vulkan driver failed with code {} while {}",
                                                   static_cast<int>(result), doing));
  }
}

}  // namespace surefield::gpu
