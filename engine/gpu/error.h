#pragma once

#include <vulkan/vulkan.h>

#include <stdexcept>
#include <string>

namespace surefield::gpu {

/// A failure of the device or its driver. `what()` is one line that names the thing and the way out.
class Error : public std::runtime_error {
 public:
  enum class Kind { NoDevice, MissingFeature, OutOfMemory, DeviceLost, Limit, Driver };

  Error(Kind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

/// Throws the Error that fits `result` unless it is VK_SUCCESS; `doing` completes "... while <doing>".
void check(VkResult result, const char* doing);

}  // namespace surefield::gpu
