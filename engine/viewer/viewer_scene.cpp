#include "engine/viewer/viewer_scene.h"

#include <algorithm>

namespace surefield {

namespace {

const Eigen::Vector4f kEstimate(1, 0.62f, 0.1f, 1);
const Eigen::Vector4f kTruth(0.25f, 0.9f, 0.4f, 1);
const Eigen::Vector4f kKeyframe(0.45f, 0.5f, 1, 0.9f);
const Eigen::Vector4f kWindow(0.2f, 0.75f, 1, 1);
const Eigen::Vector4f kLoop(0.95f, 0.3f, 0.9f, 1);
const Eigen::Vector4f kCamera(1, 0.25f, 0.3f, 1);

Camera camera_at(const ViewerScene& scene, const StampedPose& pose) {
  return {scene.frame.camera.intrinsics, pose.camera_to_world.inverse()};
}

/// What is told of keyframes may be newer than they are.
bool has_keyframe(const ViewerScene& scene, int k) {
  return k >= 0 && k < static_cast<int>(scene.keyframes.size());
}

void add_loops(std::vector<Line>& lines, const ViewerScene& scene, const OverlayChoice& choice) {
  for (const auto& [from, to] : scene.loops)
    if (has_keyframe(scene, from) && has_keyframe(scene, to))
      add_link(lines, scene.keyframes[from].camera_to_world.translation(),
               scene.keyframes[to].camera_to_world.translation(), {kLoop, 2, choice.on_top});
}

void add_window(std::vector<Line>& lines, const ViewerScene& scene, const OverlayChoice& choice) {
  const auto exists = [&](int member) { return has_keyframe(scene, member); };
  if (scene.window.empty() || !std::all_of(scene.window.begin(), scene.window.end(), exists)) return;
  const Eigen::Vector3d newest = scene.keyframes[scene.window.back()].camera_to_world.translation();
  for (int member : scene.window) {
    const StampedPose& pose = scene.keyframes[member];
    add_frustum(lines, camera_at(scene, pose), choice.frustum, {kWindow, 2, choice.on_top});
    add_link(lines, newest, pose.camera_to_world.translation(), {kWindow, 1, choice.on_top});
  }
}

}  // namespace

std::vector<Line> lines_of(const ViewerScene& scene, const OverlayChoice& choice) {
  std::vector<Line> lines;
  const bool has_frusta = scene.frame.camera.intrinsics.width > 0;
  if (choice.truth) add_path(lines, scene.truth, {kTruth, 2, choice.on_top});
  if (choice.trajectory) add_path(lines, scene.trajectory, {kEstimate, 2, choice.on_top});
  if (choice.keyframes && has_frusta)
    for (const StampedPose& pose : scene.keyframes)
      add_frustum(lines, camera_at(scene, pose), choice.keyframe_frustum(), {kKeyframe, 1, choice.on_top});
  if (choice.window && has_frusta) add_window(lines, scene, choice);
  if (choice.loops) add_loops(lines, scene, choice);
  if (choice.camera && scene.frame.index >= 0)
    add_frustum(lines, scene.frame.camera, 1.3 * choice.frustum, {kCamera, 2, choice.on_top});
  return lines;
}

}  // namespace surefield
