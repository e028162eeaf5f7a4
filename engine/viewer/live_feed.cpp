#include "engine/viewer/live_feed.h"

namespace surefield {

bool LiveFeed::may_go_on(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  const auto free = [this] { return !paused_ || steps_ > 0 || stop_; };
  if (!unpaused_.wait_for(lock, patience, free)) return false;
  if (steps_ > 0) --steps_;
  return true;
}

void LiveFeed::announce(ViewerScene scene) {
  std::lock_guard lock(mutex_);
  update_.scene = std::move(scene);
}

void LiveFeed::publish(const FrameNumbers& numbers, bool keyframe, const std::function<ViewerScene()>& scene,
                       const std::function<GaussianCloud()>& map) {
  bool with_scene = false, with_map = false;
  {
    std::lock_guard lock(mutex_);
    update_.numbers.push_back(numbers);
    with_scene = wants_scene_;
    with_map = wants_map_ && keyframe;
  }
  // Made without the lock, so that the window does not wait either.
  std::optional<ViewerScene> new_scene;
  std::optional<GaussianCloud> new_map;
  if (with_scene) new_scene = scene();
  if (with_map) new_map = map();
  std::lock_guard lock(mutex_);
  if (new_scene) update_.scene = std::move(new_scene);
  if (new_map) update_.map = std::move(new_map);
  wants_scene_ = wants_scene_ && !with_scene;
  wants_map_ = wants_map_ && !with_map;
}

void LiveFeed::finish(ViewerScene scene, GaussianCloud map) {
  std::lock_guard lock(mutex_);
  update_.scene = std::move(scene);
  update_.map = std::move(map);
  update_.finished = true;
}

std::vector<std::pair<std::string, double>> LiveFeed::take_changes() {
  std::lock_guard lock(mutex_);
  return std::exchange(changes_, {});
}

bool LiveFeed::stop_wanted() const {
  std::lock_guard lock(mutex_);
  return stop_;
}

LiveFeed::Update LiveFeed::take() {
  std::lock_guard lock(mutex_);
  wants_scene_ = wants_map_ = true;
  return std::exchange(update_, {});
}

void LiveFeed::pause(bool on) {
  std::lock_guard lock(mutex_);
  paused_ = on;
  steps_ = 0;
  unpaused_.notify_all();
}

bool LiveFeed::paused() const {
  std::lock_guard lock(mutex_);
  return paused_;
}

void LiveFeed::step() {
  std::lock_guard lock(mutex_);
  ++steps_;
  unpaused_.notify_all();
}

void LiveFeed::change(const std::string& key, double value) {
  std::lock_guard lock(mutex_);
  changes_.emplace_back(key, value);
}

void LiveFeed::stop() {
  std::lock_guard lock(mutex_);
  stop_ = true;
  unpaused_.notify_all();
}

}  // namespace surefield
