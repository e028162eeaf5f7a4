#include "engine/primitives/device_count.h"

#include <fmt/format.h>

#include "engine/gpu/error.h"

namespace surefield {

void require_room(const DeviceCount& count, std::initializer_list<const gpu::Buffer*> buffers) {
  for (const gpu::Buffer* buffer : buffers)
    if (buffer->bytes() / sizeof(glsl::uint) < count.capacity)
      throw gpu::Error(gpu::Error::Kind::Limit,
                       fmt::format("{} has no room for {} elements", buffer->name(), count.capacity));
}

}  // namespace surefield
