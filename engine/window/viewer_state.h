#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/viewer/view_painter.h"
#include "engine/viewer/viewer_scene.h"

namespace surefield {

/// How the camera of a viewer is moved.
enum class CameraStyle {
  Orbit,   ///< around a point, by mouse
  Fly,     ///< by mouse and keys
  Follow,  ///< behind the tracked camera, by itself
  Through  ///< in the place of the tracked camera
};

/// What the user has chosen.
struct ViewerState {
  ViewSettings view;
  OverlayChoice overlay;
  CameraStyle style = CameraStyle::Orbit;
  bool interface = true;  ///< the panel is shown
  bool running = true;    ///< playback goes on, or SLAM is not paused
  int position = 0;       ///< of a recorded trajectory: whose frame is shown
  int coarseness = 1;     ///< a pixel of the picture is so many of the window wide
  bool stop_on_close = false;

  bool operator==(const ViewerState&) const = default;
};

/// What the user asks to be done once.
struct ViewerRequests {
  bool screenshot = false;
  bool save_map = false;
  bool step = false;
  bool reset = false;  ///< the camera
  bool stop = false;   ///< end the run
  bool close = false;
  int keyframes = 0;  ///< jump so many forward or back
};

/// A key of the viewer.
struct KeyBinding {
  int key;           ///< GLFW_KEY_...
  const char* name;  ///< as people call it
  const char* what;  ///< it does
  void (*act)(ViewerState&, ViewerRequests&);
};

/// All keys but those of the modes (1 to 9, 0 and -) and those that move while they are held.
std::span<const KeyBinding> key_bindings();

/// Does what a key is for.
void press_key(int key, ViewerState& state, ViewerRequests& requests);

}  // namespace surefield
