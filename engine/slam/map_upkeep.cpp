#include "engine/slam/map_upkeep.h"

#include <algorithm>
#include <map>

#include "engine/slam/exposure.h"
#include "engine/slam/spawn.h"

namespace surefield {

namespace {

constexpr int kLoopSteps = 100;  // over both visits of a place, once a loop is closed

}  // namespace

void MapUpkeep::begin(const Frame& frame) {
  const Camera& camera = keyframes_[keyframes_.newest()].camera;
  extent_ = scene_extent(frame);
  pixel_ = extent_ * 2 / (camera.intrinsics.fx + camera.intrinsics.fy);
  engine_.assign(spawn_gaussians(frame, camera, nullptr, settings_.spawn), settings_.depth_model);
}

void MapUpkeep::spawn(const Frame& frame) {
  const int newest = keyframes_.newest();
  const Camera& camera = keyframes_[newest].camera;
  const RenderImages rendered = engine_.render(camera);
  Eigen::Vector3f gains = keyframes_[newest].gains;
  if (settings_.keyframes.exposure)
    gains = fit_gains(frame, rendered).value_or(keyframes_[std::max(0, newest - 1)].gains);
  keyframes_.set_gains(newest, gains);
  GaussianCloud births = spawn_gaussians(frame, camera, &rendered, settings_.spawn, gains);
  births.anchors.assign(births.size(), static_cast<uint32_t>(newest));
  region_.settle(keyframes_.all(), keyframes_.similar(), static_cast<uint32_t>(births.size()));
  engine_.insert(births);
}

MappingPlan MapUpkeep::plan(const KeyframeWindow& window) {
  const auto order = mapping_order(window, near(), settings_.mapping_iterations,
                                   settings_.keyframes.past_keyframes, random_);
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(order.size() / 2);
  MappingPlan plan{{order.begin(), middle}, {middle, order.end()}, {}};
  const MappingSettings& mapping = settings_.mapping;
  if (mapping.rate_pose_rotation > 0 || mapping.rate_pose_translation > 0)
    std::copy_if(window.members.begin(), window.members.end(), std::back_inserter(plan.refined),
                 [&](int member) { return member != window.fixed; });
  return plan;
}

std::vector<int> MapUpkeep::plan_both(int back_at) {
  std::vector<int> members = keyframes_.window();
  for (int k = std::max(0, back_at - 2); k <= std::min(back_at + 2, keyframes_.newest()); ++k)
    if (std::find(members.begin(), members.end(), k) == members.end()) members.push_back(k);
  region_.settle(keyframes_.all(), members, 0);
  std::vector<int> order;
  for (int step = 0; step < kLoopSteps; ++step)
    order.push_back(members[static_cast<std::size_t>(step) % members.size()]);
  return order;
}

void MapUpkeep::give_time(double milliseconds) {
  until_.reset();
  if (!(milliseconds > 0)) return;
  using Clock = std::chrono::steady_clock;
  until_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                              std::chrono::duration<double, std::milli>(milliseconds));
}

MappingLimit MapUpkeep::limit(double share) const {
  MappingLimit limit{stop_};
  if (!until_) return limit;
  const auto now = std::chrono::steady_clock::now();
  const auto part = std::chrono::duration<double>(*until_ - now) * share;
  limit.until = now + std::chrono::duration_cast<std::chrono::steady_clock::duration>(part);
  return limit;
}

void MapUpkeep::optimise(const std::vector<int>& order, const std::vector<int>& refined, FrameReport& report,
                         double share) {
  std::vector<MappingView> views;
  std::map<int, int> view_of_keyframe;
  std::vector<int> steps;
  for (int k : order) {
    const auto [entry, is_new] = view_of_keyframe.try_emplace(k, static_cast<int>(views.size()));
    if (is_new)
      views.push_back({keyframes_[k].frame, keyframes_[k].camera,
                       std::find(refined.begin(), refined.end(), k) != refined.end(), keyframes_[k].gains});
    steps.push_back(entry->second);
  }
  const MappingResult result = engine_.optimise(views, steps, settings_.mapping, pixel_, limit(share));
  for (const auto& [k, view] : view_of_keyframe) keyframes_.move(k, views[view].camera.world_to_camera);
  report.mapping_iterations += result.iterations;
  report.mapping_ms += result.milliseconds;
}

void MapUpkeep::judge(const std::vector<int>& members, FrameReport& report) {
  if (stop_.stop_requested()) return;
  std::vector<MappingView> views;
  for (int member : members) views.push_back({keyframes_[member].frame, keyframes_[member].camera, false});
  const JudgeResult result = engine_.judge(views, settings_.mapping);
  report.uncertain_gaussians = result.uncertain;
  report.mapping_ms += result.milliseconds;
}

void MapUpkeep::densify() {
  if (stop_.stop_requested()) return;
  DensifySettings densify = settings_.densify;
  densify.extent = extent_;
  densify.seed = random_();
  engine_.densify(densify);
}

}  // namespace surefield
