#pragma once

#include <string>

#include "engine/types/camera.h"
#include "engine/types/gaussian_cloud.h"
#include "engine/types/trajectory.h"

namespace surefield {

/// What the web page of a map shows. All poses are camera to world in the map's world.
struct WebPageContent {
  std::string title;
  GaussianCloud map;
  Intrinsics camera;    ///< how keyframes are drawn, and the field of view to start with
  Eigen::Vector3d up;   ///< of the world, unit length
  Trajectory estimate;  ///< may be empty, as the following
  Trajectory truth;
  Trajectory keyframes;
};

/// One HTML page that shows the map in any browser with WebGL2 and needs nothing else, no network either
/// (docs/formats.md, "Web page"). Poses that are not finite are left out. Throws InputError where the map is
/// too large for SPZ.
std::string web_page(const WebPageContent& content);

}  // namespace surefield
