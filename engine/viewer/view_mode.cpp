#include "engine/viewer/view_mode.h"

#include <algorithm>
#include <array>

namespace surefield {

namespace {

constexpr std::array kModes = {
    ViewModeInfo{ViewMode::Colour, "colour", "Colour"},
    ViewModeInfo{ViewMode::Depth, "depth", "Depth"},
    ViewModeInfo{ViewMode::MedianDepth, "median-depth", "Median depth"},
    ViewModeInfo{ViewMode::Opacity, "opacity", "Opacity"},
    ViewModeInfo{ViewMode::Uncertainty, "uncertainty", "Uncertainty of the depth", true},
    ViewModeInfo{ViewMode::GaussianUncertainty, "gaussian-uncertainty", "Uncertainty of the Gaussians"},
    ViewModeInfo{ViewMode::Ellipsoids, "ellipsoids", "Ellipsoids"},
    ViewModeInfo{ViewMode::Points, "points", "Centres"},
    ViewModeInfo{ViewMode::Normals, "normals", "Normals"},
    ViewModeInfo{ViewMode::Sensor, "sensor", "Camera image", true},
    ViewModeInfo{ViewMode::Error, "error", "Error of the colours", true},
};

}  // namespace

std::span<const ViewModeInfo> view_modes() {
  return kModes;
}

const ViewModeInfo& info_of(ViewMode mode) {
  return kModes[static_cast<std::size_t>(mode)];
}

std::optional<ViewMode> find_view_mode(const std::string& name) {
  const auto found =
      std::find_if(kModes.begin(), kModes.end(), [&](const ViewModeInfo& info) { return info.name == name; });
  return found == kModes.end() ? std::nullopt : std::optional(found->mode);
}

}  // namespace surefield
