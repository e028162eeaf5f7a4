#include "tools/view/render_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/formats/map_file.h"
#include "engine/types/error.h"

namespace surefield {

std::vector<ViewMode> chosen_modes(const RenderOptions& options,
                                   const std::function<const char*(ViewMode)>& missing) {
  std::vector<ViewMode> modes;
  for (const ViewModeInfo& info : view_modes()) {
    const auto asked = [&](const char* name) {
      return std::find(options.modes.begin(), options.modes.end(), name) != options.modes.end();
    };
    const char* lack = missing(info.mode);
    if (asked(info.name) && lack) throw InputError(fmt::format("--mode {} needs {}", info.name, lack));
    if (asked(info.name) || (asked(kAllModes) && !lack)) modes.push_back(info.mode);
  }
  return modes;
}

GaussianCloud load_finite_map(const std::string& file) {
  MapFile map = read_map(file);
  if (map.dropped > 0) {
    fmt::print(stderr, "surefield: warning: {}: {} Gaussians are not finite and were left out\n", file,
               map.dropped);
  }
  return std::move(map.cloud);
}

}  // namespace surefield
