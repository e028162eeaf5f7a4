#include "engine/splat/map_rebuild.h"

namespace surefield {

MapRebuild::MapRebuild(gpu::Device& device)
    : sources(device, "sources"),
      device_(device),
      gather_(device, gpu::kWorkgroup),
      rebuilt_(device, "rebuilt array") {}

void MapRebuild::rebuild(GaussianMap& map, std::span<const uint32_t> new_sources) {
  const auto count = static_cast<uint32_t>(new_sources.size());
  sources.upload(new_sources);
  gpu::Recorder recorder(device_);
  map.for_each_array([&]<class T>(gpu::Array<T>& array, uint32_t words, bool state) {
    const uint64_t bytes = uint64_t{count} * words * sizeof(glsl::uint);
    if (bytes == 0) return;
    recorder.reserve(rebuilt_, bytes / sizeof(glsl::uint));
    recorder.dispatch(gather_, gather_.groups(count),
                      {.sources = sources, .from = gpu::as_words(array), .to = rebuilt_},
                      {.count = count, .words = words, .only_kept = state ? 1u : 0u});
    const bool grows = bytes > array.buffer().bytes();
    recorder.reserve(array, bytes / sizeof(T));
    recorder.copy({&rebuilt_.buffer(), 0, bytes}, {&array.buffer(), 0, bytes});
    if (grows) recorder.submit();  // so that there is a second copy of one array at a time
  });
  recorder.submit();
  map.set_size(count);
}

}  // namespace surefield
