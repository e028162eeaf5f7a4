#pragma once

#include <cstdint>
#include <initializer_list>

#include "engine/gpu/buffer.h"
#include "engine/gpu/glsl_types.h"

namespace surefield {

/// A number of elements that lives on the device (entry 0) with the largest value that it may take. Kernels
/// clamp the device's value to `capacity`.
struct DeviceCount {
  const gpu::Array<glsl::uint>& value;
  uint32_t capacity;
};

/// Throws gpu::Error(Limit) unless every one of `buffers`, arrays of 4-byte elements, has room for the
/// capacity.
void require_room(const DeviceCount& count, std::initializer_list<const gpu::Buffer*> buffers);

}  // namespace surefield
