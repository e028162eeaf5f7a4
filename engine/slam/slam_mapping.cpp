#include <algorithm>
#include <map>

#include "engine/slam/exposure.h"
#include "engine/slam/slam_implementation.h"
#include "engine/slam/spawn.h"

namespace surefield {

void Slam::Implementation::add_keyframe(const Frame& frame, FrameHandle handle, const Pose& world_to_camera) {
  const Camera camera{intrinsics, world_to_camera};
  covisibility.add(frame);
  keyframes.push_back(
      make_keyframe(frame, handle, camera, sample_points(frame, intrinsics, settings.depth_max)));
  frames.back() = {frame.timestamp, static_cast<int>(keyframes.size()) - 1, Pose::Identity()};
  last_keyframe_frame = static_cast<int>(frames.size()) - 1;
  valid_after_keyframe = 0;
  const RenderImages rendered = engine.render(camera);
  Eigen::Vector3f& gains = keyframes.back().gains;
  gains = keyframes[keyframes.size() - 2].gains;
  if (settings.keyframes.exposure) gains = fit_gains(frame, rendered, settings.depth_max).value_or(gains);
  const GaussianCloud births =
      spawn_gaussians(frame, camera, &rendered, settings.spawn, settings.depth_max, gains);
  region.settle(keyframes, covisibility.similar(), static_cast<uint32_t>(births.size()));
  engine.insert(births);
}

void Slam::Implementation::map_window(FrameReport& report) {
  const KeyframeWindow chosen = covisibility.window(keyframes, region.near());
  const auto order = mapping_order(chosen, region.near(), settings.mapping_iterations,
                                   settings.keyframes.past_keyframes, random);
  std::vector<int> refined;
  const bool refines = settings.mapping.rate_pose_rotation > 0 || settings.mapping.rate_pose_translation > 0;
  for (int member : chosen.members)
    if (refines && member != chosen.fixed) refined.push_back(member);
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(order.size() / 2);
  optimise({order.begin(), middle}, refined, report);
  judge(chosen.members, report);
  densify();
  optimise({middle, order.end()}, refined, report);
  report.world_to_camera = keyframes.back().camera.world_to_camera;
  align_to(chosen.members);
  window = chosen.members;
}

/// Takes keyframes of the window, the newest first, as what frames are aligned to beside the map.
void Slam::Implementation::align_to(std::vector<int> members) {
  std::reverse(members.begin(), members.end());
  members.resize(std::min<std::size_t>(members.size(), std::max(settings.tracking.references, 0)));
  reference_keyframes = std::move(members);
}

void Slam::Implementation::optimise(const std::vector<int>& order, const std::vector<int>& refined,
                                    FrameReport& report) {
  std::vector<MappingView> views;
  std::map<int, int> view_of_keyframe;
  std::vector<int> steps;
  for (int keyframe : order) {
    const auto [entry, is_new] = view_of_keyframe.try_emplace(keyframe, static_cast<int>(views.size()));
    if (is_new)
      views.push_back({keyframes[keyframe].frame, keyframes[keyframe].camera,
                       std::find(refined.begin(), refined.end(), keyframe) != refined.end(),
                       keyframes[keyframe].gains});
    steps.push_back(entry->second);
  }
  const MappingResult result = engine.optimise(views, steps, settings.mapping, extent);
  for (const auto& [keyframe, view] : view_of_keyframe) keyframes[keyframe].camera = views[view].camera;
  report.mapping_iterations += result.iterations;
  report.mapping_ms += result.milliseconds;
}

/// Takes the opacity from Gaussians that are uncertain over the window's keyframes.
void Slam::Implementation::judge(const std::vector<int>& members, FrameReport& report) {
  std::vector<MappingView> views;
  for (int member : members) views.push_back({keyframes[member].frame, keyframes[member].camera, false});
  const JudgeResult result = engine.judge(views, settings.mapping);
  report.uncertain_gaussians = result.uncertain;
  report.mapping_ms += result.milliseconds;
}

void Slam::Implementation::densify() {
  DensifySettings densify = settings.densify;
  densify.extent = extent;
  densify.seed = random();
  engine.densify(densify);
}

}  // namespace surefield
