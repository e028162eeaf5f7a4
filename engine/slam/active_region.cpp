#include "engine/slam/active_region.h"

namespace surefield {

namespace {

WorldPoints in_world(const std::vector<Eigen::Vector3f>& points, const Pose& world_to_camera) {
  const Eigen::Isometry3f camera_to_world = world_to_camera.inverse().cast<float>();
  WorldPoints moved;
  moved.reserve(points.size());
  for (const Eigen::Vector3f& point : points) moved.push_back(camera_to_world * point);
  return moved;
}

void add_views(std::vector<WorldPoints>& regions, const std::vector<Keyframe>& keyframes,
               const std::vector<int>& positions) {
  for (int k : positions)
    regions.push_back(in_world(keyframes[k].points, keyframes[k].camera.world_to_camera));
}

}  // namespace

ActiveRegion::ActiveRegion(SplatEngine& engine, const SlamSettings& settings)
    : engine_(engine), most_(settings.keyframes.near) {
  engine.set_map_budget(static_cast<uint64_t>(settings.map_device_mb * 1e6));
}

void ActiveRegion::approach(const std::vector<Keyframe>& keyframes,
                            const std::vector<Eigen::Vector3f>& points, const Pose& world_to_camera) {
  if (engine_.is_whole()) return;
  std::vector<WorldPoints> regions{in_world(points, world_to_camera)};
  if (engine_.recall(regions[0])) return;
  add_views(regions, keyframes, near_);
  engine_.focus(regions, 0);
}

void ActiveRegion::settle(const std::vector<Keyframe>& keyframes, const std::vector<int>& similar,
                          uint32_t births) {
  near_ = nearest_keyframes(keyframes, most_, similar);
  if (near_.size() == keyframes.size() && engine_.is_whole(births)) return;
  std::vector<WorldPoints> regions;
  add_views(regions, keyframes, near_);
  near_.resize(engine_.focus(regions, births));
}

}  // namespace surefield
