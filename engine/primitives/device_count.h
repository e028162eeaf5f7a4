#pragma once

#include <cstdint>

#include "engine/gpu/buffer.h"
#include "engine/gpu/glsl_types.h"

namespace surefield {

/// A number of elements that lives on the device (entry 0) with the largest value that it may take. Kernels
/// clamp the device's value to `capacity`.
struct DeviceCount {
  const gpu::Array<glsl::uint>& value;
  uint32_t capacity;
};

}  // namespace surefield
