#include "engine/slam/keyframe_graph.h"

#include <algorithm>
#include <utility>

namespace surefield {

void KeyframeGraph::add(Keyframe keyframe, Eigen::VectorXf descriptor) {
  keyframes_.push_back(std::move(keyframe));
  covisibility_.add(std::move(descriptor));
}

void KeyframeGraph::forget_depth(int k, const std::vector<uint8_t>& cells) {
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i]) keyframes_[k].grid.depth[i] = 0;
}

void KeyframeGraph::move(int k, const Pose& world_to_camera) {
  Pose& pose = keyframes_[k].camera.world_to_camera;
  if (pose.matrix() == world_to_camera.matrix()) return;
  pose = world_to_camera;
  if (std::find(moved_.begin(), moved_.end(), k) == moved_.end()) moved_.push_back(k);
}

std::vector<int> KeyframeGraph::take_moved() {
  return std::exchange(moved_, {});
}

void KeyframeGraph::set_window(std::vector<int> members, int most_references) {
  references_.assign(members.rbegin(), members.rend());
  references_.resize(std::min<std::size_t>(members.size(), std::max(most_references, 0)));
  window_ = std::move(members);
}

std::vector<TrackingReference> KeyframeGraph::references() const {
  std::vector<TrackingReference> references;
  for (int k : references_) references.push_back({keyframes_[k].tracked, keyframes_[k].camera});
  return references;
}

std::vector<LitView> KeyframeGraph::lit_views() const {
  std::vector<LitView> views;
  for (int k : window_) views.push_back({keyframes_[k].grid, keyframes_[k].light, keyframes_[k].camera});
  return views;
}

}  // namespace surefield
