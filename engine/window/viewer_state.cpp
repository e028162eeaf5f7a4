#include "engine/window/viewer_state.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>

namespace surefield {

namespace {

using State = ViewerState;
using Requests = ViewerRequests;

constexpr std::array kBindings = {
    KeyBinding{GLFW_KEY_O, "O", "orbit: drag to turn, right drag to move, scroll to approach",
               [](State& s, Requests&) { s.style = CameraStyle::Orbit; }},
    KeyBinding{GLFW_KEY_F, "F", "fly: drag to look, W A S D Q E to move",
               [](State& s, Requests&) { s.style = CameraStyle::Fly; }},
    KeyBinding{GLFW_KEY_B, "B", "follow the tracked camera from behind",
               [](State& s, Requests&) { s.style = CameraStyle::Follow; }},
    KeyBinding{GLFW_KEY_C, "C", "look through the tracked camera",
               [](State& s, Requests&) { s.style = CameraStyle::Through; }},
    KeyBinding{GLFW_KEY_HOME, "Home", "back to where the view began",
               [](State&, Requests& r) { r.reset = true; }},
    KeyBinding{GLFW_KEY_SPACE, "Space", "play, pause", [](State& s, Requests&) { s.running = !s.running; }},
    KeyBinding{GLFW_KEY_N, "N", "one frame, then pause",
               [](State& s, Requests& r) {
                 s.running = false;
                 r.step = true;
               }},
    KeyBinding{GLFW_KEY_RIGHT, "Right", "a second on", [](State&, Requests& r) { r.seconds = 1; }},
    KeyBinding{GLFW_KEY_LEFT, "Left", "a second back", [](State&, Requests& r) { r.seconds = -1; }},
    KeyBinding{GLFW_KEY_PAGE_DOWN, "Page down", "next keyframe",
               [](State&, Requests& r) { r.keyframes = 1; }},
    KeyBinding{GLFW_KEY_PAGE_UP, "Page up", "previous keyframe",
               [](State&, Requests& r) { r.keyframes = -1; }},
    KeyBinding{GLFW_KEY_I, "I", "tell what is under the mouse, where it rests; a click always does",
               [](State& s, Requests&) { s.probe = !s.probe; }},
    KeyBinding{GLFW_KEY_R, "R", "ruler: two clicks give their distance",
               [](State& s, Requests& r) {
                 s.ruler = !s.ruler;
                 r.clear = true;
               }},
    KeyBinding{GLFW_KEY_DELETE, "Delete", "forget what was clicked",
               [](State&, Requests& r) { r.clear = true; }},
    KeyBinding{GLFW_KEY_U, "U", "behind the map: squares, dark, light, black",
               [](State& s, Requests&) {
                 s.backdrop = next_backdrop(s.backdrop);
                 set_backdrop(s.view, s.backdrop);
               }},
    KeyBinding{GLFW_KEY_Z, "Z", "resolution: full, half, a third, a quarter",
               [](State& s, Requests&) { s.coarseness = s.coarseness % kCoarsest + 1; }},
    KeyBinding{GLFW_KEY_Y, "Y", "colour bar, axes and scale bar on, off",
               [](State& s, Requests&) { s.scales = !s.scales; }},
    KeyBinding{GLFW_KEY_T, "T", "trajectory on, off",
               [](State& s, Requests&) { s.overlay.trajectory = !s.overlay.trajectory; }},
    KeyBinding{GLFW_KEY_G, "G", "true trajectory on, off",
               [](State& s, Requests&) { s.overlay.truth = !s.overlay.truth; }},
    KeyBinding{GLFW_KEY_K, "K", "keyframes on, off",
               [](State& s, Requests&) { s.overlay.keyframes = !s.overlay.keyframes; }},
    KeyBinding{GLFW_KEY_L, "L", "window of keyframes and its links on, off",
               [](State& s, Requests&) { s.overlay.window = !s.overlay.window; }},
    KeyBinding{GLFW_KEY_J, "J", "loops on, off: places that the camera came back to",
               [](State& s, Requests&) { s.overlay.loops = !s.overlay.loops; }},
    KeyBinding{GLFW_KEY_V, "V", "tracked camera on, off",
               [](State& s, Requests&) { s.overlay.camera = !s.overlay.camera; }},
    KeyBinding{GLFW_KEY_X, "X", "lines before the map, or behind it",
               [](State& s, Requests&) { s.overlay.on_top = !s.overlay.on_top; }},
    KeyBinding{GLFW_KEY_P, "P", "save a screenshot and its camera",
               [](State&, Requests& r) { r.screenshot = true; }},
    KeyBinding{GLFW_KEY_M, "M", "save the map", [](State&, Requests& r) { r.save_map = true; }},
    KeyBinding{GLFW_KEY_TAB, "Tab", "this panel, and all that is written on the picture, on, off",
               [](State& s, Requests&) { s.interface = !s.interface; }},
    KeyBinding{GLFW_KEY_ESCAPE, "Esc", "close the window", [](State&, Requests& r) { r.close = true; }},
};

constexpr std::array kModeKeys = {GLFW_KEY_1, GLFW_KEY_2, GLFW_KEY_3, GLFW_KEY_4, GLFW_KEY_5,    GLFW_KEY_6,
                                  GLFW_KEY_7, GLFW_KEY_8, GLFW_KEY_9, GLFW_KEY_0, GLFW_KEY_MINUS};
constexpr std::array kModeKeyNames = {"1", "2", "3", "4", "5", "6", "7", "8", "9", "0", "-"};

}  // namespace

std::span<const KeyBinding> key_bindings() {
  return kBindings;
}

const char* key_of(ViewMode mode) {
  return kModeKeyNames[static_cast<std::size_t>(mode)];
}

void ViewerRequests::add(const ViewerRequests& other) {
  screenshot |= other.screenshot;
  save_map |= other.save_map;
  step |= other.step;
  reset |= other.reset;
  clear |= other.clear;
  stop |= other.stop;
  close |= other.close;
  keyframes += other.keyframes;
  if (other.keyframe >= 0) keyframe = other.keyframe;
  seconds += other.seconds;
}

void press_key(int key, ViewerState& state, ViewerRequests& requests) {
  for (const KeyBinding& binding : kBindings)
    if (binding.key == key) binding.act(state, requests);
  const auto mode = std::find(kModeKeys.begin(), kModeKeys.end(), key);
  if (mode != kModeKeys.end()) state.view.mode = view_modes()[mode - kModeKeys.begin()].mode;
}

}  // namespace surefield
