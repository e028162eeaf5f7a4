#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/viewer/backdrop.h"
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

/// The coarsest pixel that may be chosen, in pixels of the window.
inline constexpr int kCoarsest = 4;

/// What the user has chosen.
struct ViewerState {
  ViewSettings view;
  OverlayChoice overlay;
  Backdrop backdrop = Backdrop::Squares;
  CameraStyle style = CameraStyle::Orbit;
  bool interface = true;  ///< the panel is shown, and what is written over the picture
  bool scales = true;     ///< colour bar, axes and scale bar are shown
  bool probe = false;     ///< what is under the mouse is told where it rests
  bool ruler = false;     ///< clicks set the ends of a ruler
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
  bool clear = false;  ///< what was picked and measured
  bool stop = false;   ///< end the run
  bool close = false;
  int keyframes = 0;   ///< jump so many forward or back
  int keyframe = -1;   ///< go to this one; -1: to none
  double seconds = 0;  ///< jump so many forward or back in a recorded trajectory

  /// Takes what is asked for beside this.
  void add(const ViewerRequests& other);
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
/// The key of a mode, as people call it.
const char* key_of(ViewMode mode);

/// Does what a key asks for, if it is one of key_bindings() or of a mode.
void press_key(int key, ViewerState& state, ViewerRequests& requests);

}  // namespace surefield
