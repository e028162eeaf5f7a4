#include "tools/shared/load_map.h"

#include <fmt/format.h>

#include <utility>

#include "engine/formats/map_file.h"

namespace surefield {

GaussianCloud load_map(const std::filesystem::path& file) {
  MapFile map = read_map(file);
  const std::size_t left_out = map.dropped + map.invisible;
  if (left_out > 0) {
    fmt::print(stderr, "surefield: warning: {}: {} of {} Gaussians were left out: {}\n", file.string(),
               left_out, map.cloud.size() + left_out, left_out_text(map.dropped, map.invisible));
  }
  return std::move(map.cloud);
}

}  // namespace surefield
