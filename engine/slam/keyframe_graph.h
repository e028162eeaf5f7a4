#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "engine/places/place_memory.h"
#include "engine/slam/covisibility.h"
#include "engine/slam/keyframes.h"
#include "engine/slam/light.h"
#include "engine/slam/settings.h"

namespace surefield {

/// The keyframes of a run and what they have to do with each other: who sees the same, which were optimised
/// together, which ones frames are aligned to. Sole owner of the keyframes' poses. A keyframe is named by its
/// position in the order of adding.
class KeyframeGraph {
 public:
  /// `descriptor` says what images look like, instead of the one that the settings name, unless null. Throws
  /// InputError where a file that the settings name cannot be used.
  KeyframeGraph(const KeyframeSettings& settings, std::unique_ptr<ImageDescriptor> descriptor);

  bool empty() const { return keyframes_.empty(); }
  int newest() const { return static_cast<int>(keyframes_.size()) - 1; }
  const Keyframe& operator[](int k) const { return keyframes_[k]; }
  const std::vector<Keyframe>& all() const { return keyframes_; }
  const Pose& world_to_camera(int k) const { return keyframes_[k].camera.world_to_camera; }

  /// The descriptor of a frame that may become a keyframe, empty where images are not described. Changes
  /// nothing; throws what the descriptor throws.
  Eigen::VectorXf describe(const Frame& frame) { return covisibility_.describe(frame); }
  /// Adds a keyframe, with its descriptor.
  void add(Keyframe keyframe, Eigen::VectorXf descriptor);
  /// Puts another in the place of the first and only one, with the same descriptor.
  void replace_first(Keyframe keyframe);
  /// Times these its colours are the map's, for mapping and for telling the light of frames; the image that
  /// frames are aligned to stays as it is.
  void set_light(int k, const Eigen::Vector3f& gains) { keyframes_[k].gains = keyframes_[k].light = gains; }
  void set_gains(int k, const Eigen::Vector3f& gains) { keyframes_[k].gains = gains; }

  /// A keyframe's grid has no depth any more in the cells that are flagged.
  void forget_depth(int k, const std::vector<uint8_t>& cells);

  /// Refines the pose of a keyframe.
  void move(int k, const Pose& world_to_camera);
  /// The keyframes whose poses have become others since the last call, in no particular order.
  std::vector<int> take_moved();

  /// The keyframes that look most like the newest one; see Covisibility::similar().
  std::vector<int> similar() const { return covisibility_.similar(); }
  /// The keyframes that are optimised together with the newest one, out of those `near` it.
  KeyframeWindow choose_window(const std::vector<int>& near) const {
    return covisibility_.window(keyframes_, near);
  }

  /// What the keyframes look like, all of them.
  const PlaceMemory& places() const { return places_; }

  /// Notes that these were optimised together, oldest first: frames are aligned to the newest of them, at
  /// most so many, beside the map.
  void set_window(std::vector<int> members, int most_references);
  /// Those that were optimised together last, oldest first.
  const std::vector<int>& window() const { return window_; }
  /// The keyframe that frames are tracked after: the newest of the last window, or where a lost camera was
  /// found again. -1 where there is none.
  int anchor() const { return anchor_; }
  /// From here on frames are aligned to this keyframe and those beside it, at most so many: a lost camera was
  /// found there.
  void return_to(int k, int most_references);
  /// The keyframes whose images a frame is aligned to beside the map, the newest first.
  std::vector<TrackingReference> references() const;
  /// Those of a frame that is taken at keyframe `k`.
  std::vector<TrackingReference> references_at(int k) const;
  /// Which those are.
  const std::vector<int>& reference_keyframes() const { return references_; }
  /// The keyframes by which the exposure of a frame is told: those of the last window. Good until the next
  /// change.
  std::vector<LitView> lit_views() const;

 private:
  Covisibility covisibility_;
  PlaceMemory places_;
  std::vector<Keyframe> keyframes_;
  std::vector<int> moved_;
  std::vector<int> window_;
  std::vector<int> references_;
  int anchor_ = -1;
};

}  // namespace surefield
