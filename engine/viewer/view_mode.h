#pragma once

#include <optional>
#include <span>
#include <string>

namespace surefield {

/// What a picture of the map shows.
enum class ViewMode {
  Colour,
  Depth,                ///< D_alpha / O, faint where O is small
  MedianDepth,          ///< of the Gaussian at which half of the light has been stopped
  Opacity,              ///< O from black to white
  Uncertainty,          ///< root of U (paper eq. 12) against the sensor's depth
  GaussianUncertainty,  ///< root of the uncertainty of the Gaussians (eq. 13), blended
  Ellipsoids,           ///< Gaussians of 2 standard deviations, solid
  Points,               ///< the centres of the Gaussians
  Normals,              ///< the shortest axes, blended; x right is red, y up green, z to the viewer blue
  Sensor,               ///< the camera's image
  Error                 ///< where the map's colours differ from the camera's image, which is grey
};

/// A mode as people name and choose it.
struct ViewModeInfo {
  ViewMode mode;
  const char* name;           ///< on the command line, in files
  const char* title;          ///< in the window
  bool needs_sensor = false;  ///< only seen from the pose of a frame
};

/// All modes, in the order of the enumeration.
std::span<const ViewModeInfo> view_modes();

const ViewModeInfo& info_of(ViewMode mode);

/// The mode of that name; nullopt where there is none.
std::optional<ViewMode> find_view_mode(const std::string& name);

}  // namespace surefield
