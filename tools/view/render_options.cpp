#include "tools/view/render_options.h"

#include <fmt/format.h>

#include <algorithm>

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

}  // namespace surefield
