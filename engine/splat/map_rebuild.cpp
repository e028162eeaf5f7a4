#include "engine/splat/map_rebuild.h"

#include <algorithm>

namespace surefield {

MapRebuild::MapRebuild(gpu::Device& device)
    : sources(device, "sources"), device_(device), gather_(device, gpu::kWorkgroup) {}

void MapRebuild::rebuild(GaussianMap& map, std::span<const uint32_t> new_sources) {
  const auto count = static_cast<uint32_t>(new_sources.size());
  sources.upload(new_sources);
  gpu::Recorder recorder(device_);
  map.for_each_array([&]<class T>(gpu::Array<T>& array, uint32_t words, bool state) {
    const uint64_t entries = uint64_t{count} * words * sizeof(glsl::uint) / sizeof(T);
    gpu::Array<T> rebuilt(device_, array.buffer().name(), std::max(entries, array.capacity()));
    recorder.dispatch(gather_, gather_.groups(count),
                      {.sources = sources, .from = gpu::as_words(array), .to = gpu::as_words(rebuilt)},
                      {.count = count, .words = words, .only_kept = state ? 1u : 0u});
    recorder.replace(array, std::move(rebuilt));
    recorder.submit();  // one by one: there is a second copy of one array at a time
  });
  map.set_size(count);
}

}  // namespace surefield
