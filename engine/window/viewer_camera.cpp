// How the viewer's camera moves, and through the recording.
#include <algorithm>
#include <cmath>

#include "engine/window/viewer_app.h"

namespace surefield {

namespace {

constexpr double kTurn = 2.5;     // radians that a drag over the window's height turns
constexpr double kScroll = 0.85;  // of the distance that a notch leaves
constexpr double kSpeed = 0.8;    // metres a second while a key is held

}  // namespace

/// Moves the camera by hand; returns whether it moved. Whoever drags takes it from where it followed.
bool ViewerApp::move_camera(const UserInput& input, double seconds) {
  const int height = std::max(window_.pixels().y(), 1);
  const Eigen::Vector2d turn = kTurn / height * input.drag_left;
  const bool by_mouse = input.drag_left.norm() + input.drag_right.norm() + std::abs(input.scroll) > 0;
  if (by_mouse && state_.style != CameraStyle::Fly) state_.style = CameraStyle::Orbit;
  Eigen::Vector3d along = Eigen::Vector3d::Zero();
  if (state_.style == CameraStyle::Fly) {
    const auto axis = [&](int more, int less) { return window_.is_down(more) - window_.is_down(less); };
    along = {static_cast<double>(axis(GLFW_KEY_D, GLFW_KEY_A)),
             static_cast<double>(axis(GLFW_KEY_Q, GLFW_KEY_E)),
             static_cast<double>(axis(GLFW_KEY_W, GLFW_KEY_S))};
    camera_.turn(-turn.x(), -turn.y());
    camera_.move(kSpeed * std::min(seconds, 0.2) * along);
  } else {
    camera_.orbit(turn.x(), turn.y());
  }
  camera_.pan(input.drag_right.x(), input.drag_right.y(), height);
  if (input.scroll != 0) camera_.approach(std::pow(kScroll, input.scroll));
  return by_mouse || along.norm() > 0;
}

/// Puts the camera where it is not moved by hand.
void ViewerApp::place_camera() {
  const SceneFrame& frame = input_.scene.frame;
  if (frame.index < 0) return;
  if (state_.style == CameraStyle::Through || info_of(shown_mode()).needs_sensor)
    camera_.look_through(frame.camera);
  else if (state_.style == CameraStyle::Follow)
    camera_.follow(frame.camera.world_to_camera.inverse());
}

/// Goes on through a recorded trajectory.
void ViewerApp::play(double seconds) {
  if (!plays()) return;
  state_.position = playback_.advance(Timeline(input_.scene.trajectory), state_.position, seconds);
}

void ViewerApp::choose_frame(int position) {
  ViewerScene& scene = input_.scene;
  state_.position = std::clamp(position, 0, std::max(static_cast<int>(scene.trajectory.size()) - 1, 0));
  if (scene.trajectory.empty() || !scene.trajectory[state_.position].is_finite()) return;
  if (!input_.load_frame && scene.frame.index != state_.position) {
    // Of a run that has just ended, there are images of the last frame alone.
    scene.frame.colour.release();
    scene.frame.depth.release();
  }
  scene.frame.index = state_.position;
  scene.frame.camera.world_to_camera = scene.trajectory[state_.position].camera_to_world.inverse();
  repaint_ = true;
}

void ViewerApp::jump_seconds(double seconds) {
  if (seconds == 0 || input_.live) return;
  const Timeline timeline(input_.scene.trajectory);
  choose_frame(timeline.position_at(std::max(timeline.seconds_at(state_.position) + seconds, 0.0)));
}

/// The newest keyframe that is not later than the frame shown; -1: none.
int ViewerApp::keyframe_shown() const {
  const ViewerScene& scene = input_.scene;
  if (scene.trajectory.empty()) return -1;
  const auto position = std::min<std::size_t>(state_.position, scene.trajectory.size() - 1);
  const auto later = [](double t, const StampedPose& pose) { return t < pose.timestamp; };
  const auto next = std::upper_bound(scene.keyframes.begin(), scene.keyframes.end(),
                                     scene.trajectory[position].timestamp, later);
  return static_cast<int>(next - scene.keyframes.begin()) - 1;
}

/// Looks from a keyframe, and shows its frame.
void ViewerApp::go_to_keyframe(int index) {
  const ViewerScene& scene = input_.scene;
  if (scene.keyframes.empty() || scene.trajectory.empty()) return;
  const int last = static_cast<int>(scene.keyframes.size()) - 1;
  const StampedPose& keyframe = scene.keyframes[std::clamp(index, 0, last)];
  const auto found = std::lower_bound(scene.trajectory.begin(), scene.trajectory.end(), keyframe.timestamp,
                                      [](const StampedPose& pose, double t) { return pose.timestamp < t; });
  const auto position = static_cast<int>(found - scene.trajectory.begin());
  if (input_.live)
    state_.position = position;
  else
    choose_frame(position);
  camera_.look_through({scene.frame.camera.intrinsics, keyframe.camera_to_world.inverse()});
  state_.style = CameraStyle::Orbit;
  state_.running = state_.running && input_.live;
  repaint_ = true;
}

}  // namespace surefield
