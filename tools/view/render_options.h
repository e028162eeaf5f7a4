#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/splat/engine.h"
#include "engine/viewer/view_painter.h"
#include "tools/shared/picture_size.h"
#include "tools/shared/up_option.h"

namespace surefield {

inline constexpr const char* kAllModes = "all";

/// What the user asks `surefield render` to do.
struct RenderOptions {
  std::string map;     ///< empty: that of the run
  std::string camera;  ///< a file; empty: that of the path
  std::string out;
  std::string sensor_depth;        ///< empty: none
  double depth_scale = 0;          ///< steps per metre
  std::string sensor_colour;       ///< empty: none
  std::vector<std::string> modes;  ///< empty: values and not pictures, or along a path colour
  ViewSettings view;
  EngineOptions engine;

  // Along a path.
  std::string path;                ///< one of view_paths(), or a file; empty: one picture, of the camera
  std::string run;                 ///< folder of a run; empty: none
  std::string dataset;             ///< where its dataset is now; empty: where it was
  std::vector<std::string> shown;  ///< of shown_things()
  PictureSize size;                ///< of the pictures; zero: that of the camera
  double rate = 25;                ///< pictures a second
  double seconds = 12;             ///< of an orbit
  UpChoice up;                     ///< of an orbit
};

/// The modes that the user asks for, in their order; "all" are those for which nothing is missing.
/// `missing` tells which option a mode lacks, or nullptr. Throws InputError where a mode that is asked for
/// lacks one.
std::vector<ViewMode> chosen_modes(const RenderOptions& options,
                                   const std::function<const char*(ViewMode)>& missing);

}  // namespace surefield
