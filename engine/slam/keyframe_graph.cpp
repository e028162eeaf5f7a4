#include "engine/slam/keyframe_graph.h"

#include <algorithm>
#include <utility>

namespace surefield {

KeyframeGraph::KeyframeGraph(const KeyframeSettings& settings, std::unique_ptr<ImageDescriptor> descriptor)
    : covisibility_(settings, std::move(descriptor)),
      places_(settings.vocabulary.empty() ? built_in_vocabulary() : read_vocabulary(settings.vocabulary)) {}

void KeyframeGraph::replace_first(Keyframe keyframe) {
  places_.replace_last(to_floats(keyframe.features.descriptors));
  keyframes_.front() = std::move(keyframe);
}

void KeyframeGraph::add(Keyframe keyframe, Eigen::VectorXf descriptor) {
  places_.add(to_floats(keyframe.features.descriptors));
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
  anchor_ = members.back();
  window_ = std::move(members);
}

void KeyframeGraph::return_to(int k, int most_references) {
  std::vector<int> members;
  for (int near = std::max(0, k - 1); near <= std::min(k + 2, newest()); ++near)
    if (near != k) members.push_back(near);
  members.push_back(k);
  set_window(std::move(members), most_references);
}

std::vector<TrackingReference> KeyframeGraph::references_at(int k) const {
  std::vector<TrackingReference> references;
  for (int near : {k, k - 1, k + 1, k + 2})
    if (near >= 0 && near <= newest())
      references.push_back({keyframes_[near].tracked, keyframes_[near].camera});
  return references;
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
