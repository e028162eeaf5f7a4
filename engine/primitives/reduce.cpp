#include "engine/primitives/reduce.h"

#include <algorithm>

namespace surefield {

Reduce::Reduce(gpu::Device& device)
    : chunks_(device, 64),
      total_(device, glsl::REDUCE_LANES),
      partial_sums_(device, "partial sums", glsl::REDUCE_CHUNKS) {}

void Reduce::sum(gpu::Recorder& recorder, const gpu::Array<float>& values, const gpu::Array<float>& result,
                 const DeviceCount& count) {
  require_room(count, {&values.buffer()});
  const uint32_t chunks = std::min(count.capacity / glsl::REDUCE_CHUNK_LEAST + 1, glsl::REDUCE_CHUNKS);
  recorder.dispatch(chunks_, chunks_.groups(chunks),
                    {.count = count.value, .values = values, .partial_sums = partial_sums_},
                    {.capacity = count.capacity});
  recorder.dispatch(total_, 1, {.count = count.value, .partial_sums = partial_sums_, .result = result},
                    {.capacity = count.capacity});
}

}  // namespace surefield
