#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/config/config.h"
#include "engine/splat/engine.h"
#include "engine/viewer/live_feed.h"

namespace surefield {

/// What a viewer shows, and what it may do.
struct ViewerInput {
  std::string title;
  std::filesystem::path out;  ///< folder of screenshots and saved maps
  EngineOptions engine;
  DepthModel depth_model = DepthModel::Plane;
  double depth_far = 5;  ///< metres, the end of the scale of depths at first

  /// A run that goes on; nullptr: what follows is shown and does not change.
  LiveFeed* live = nullptr;
  std::vector<NumberSetting> settings;  ///< of that run, which the user may change

  GaussianCloud map;
  std::optional<Eigen::Vector3d> up;  ///< where up is in its world, unit length; nullopt: the window finds it
  ViewerScene scene;
  /// The images of the frame at a position of the trajectory; nullopt or no function: there are none.
  std::function<std::optional<SceneFrame>(int)> load_frame;

  std::function<bool()> interrupted;  ///< whether to close the window
};

/// Why no window can be shown here, with the way out; empty where one can.
std::string viewer_problem();

/// Shows a window until it is closed; returns what the validation layer had to say (with
/// EngineOptions::validate). Call it on the main thread. Throws InputError with viewer_problem() where that
/// is not empty, and gpu::Error where the device cannot show windows.
std::vector<std::string> show_viewer(ViewerInput input);

}  // namespace surefield
