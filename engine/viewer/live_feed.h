#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/types/gaussian_cloud.h"
#include "engine/viewer/viewer_scene.h"

namespace surefield {

/// Where a running SLAM, on its thread, leaves what a window, on another, shows; and where the window leaves
/// what the user wants. SLAM never waits for the window, unless the user pauses it, and takes no copy that
/// the window has not asked for.
class LiveFeed {
 public:
  /// What the window finds.
  struct Update {
    std::optional<ViewerScene> scene;   ///< without numbers
    std::vector<FrameNumbers> numbers;  ///< of the frames since the last update
    std::optional<GaussianCloud> map;
    bool finished = false;
  };

  // For SLAM:

  /// Whether the next frame may be taken: waits as long as the user has paused, up to `patience`.
  bool may_go_on(std::chrono::milliseconds patience);
  /// What is known and done before the first frame is: shown until that is.
  void announce(ViewerScene scene);
  /// A frame is done. `scene` is called where the window wants to know more than the numbers, and `map` too
  /// at a keyframe where it wants that.
  void publish(const FrameNumbers& numbers, bool keyframe, const std::function<ViewerScene()>& scene,
               const std::function<GaussianCloud()>& map);
  /// There will be no more frames: the last scene and map.
  void finish(ViewerScene scene, GaussianCloud map);
  /// Values that the user has changed since the last call: keys and numbers.
  std::vector<std::pair<std::string, double>> take_changes();
  bool stop_wanted() const;

  // For the window:

  /// What is new; asks for more.
  Update take();
  void pause(bool on);
  bool paused() const;
  /// Lets one frame pass while paused.
  void step();
  void change(const std::string& key, double value);
  /// Asks SLAM to end after the frame in work.
  void stop();

 private:
  mutable std::mutex mutex_;
  std::condition_variable unpaused_;
  Update update_;
  bool wants_scene_ = true;
  bool wants_map_ = true;
  bool paused_ = false;
  int steps_ = 0;
  bool stop_ = false;
  std::vector<std::pair<std::string, double>> changes_;
};

}  // namespace surefield
