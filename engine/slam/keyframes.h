#pragma once

#include <functional>
#include <random>
#include <vector>

#include "engine/places/rigid_match.h"
#include "engine/slam/colour_grid.h"
#include "engine/splat/engine.h"
#include "engine/types/frame.h"

namespace surefield {

/// A frame that stays for mapping.
struct Keyframe {
  int index = 0;            ///< Frame::index
  double timestamp = 0;     ///< seconds
  FrameHandle frame = 0;    ///< that mapping compares the map with
  FrameHandle tracked = 0;  ///< that frames are aligned to: in the exposure of the map
  Camera camera;
  std::vector<Eigen::Vector3f> points;               ///< a coarse grid of its depth, camera frame, metres
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< of those points
  Eigen::Vector3f gains = Eigen::Vector3f::Ones();   ///< times these its colours are the map's (exposure.h)
  ColourGrid grid;                                   ///< of the image as the camera took it
  Eigen::Vector3f light = Eigen::Vector3f::Ones();   ///< times these that image's are the map's (light.h)
  PlacedFeatures features;                           ///< of that image
};

/// A keyframe that sees `points`.
Keyframe make_keyframe(const Frame& frame, FrameHandle handle, const Camera& camera,
                       std::vector<Eigen::Vector3f> points);

/// A coarse grid of the valid depths of a frame, back-projected to the camera frame; for covisibility.
std::vector<Eigen::Vector3f> sample_points(const Frame& frame, const Intrinsics& intrinsics);

/// The fraction of the points of `from` that `to` sees inside its image: covisibility by geometric overlap,
/// in [0, 1].
double overlap(const Keyframe& from, const Keyframe& to);

/// The `count` keyframes near the newest one: itself, the one before it, those of `similar` (which look the
/// same, wherever they are thought to be), then those whose cameras, and the middles of what they see, are
/// nearest to its own. Positions in the list of keyframes.
std::vector<int> nearest_keyframes(const std::vector<Keyframe>& keyframes, int count,
                                   const std::vector<int>& similar = {});

/// The keyframes that one mapping call works on: positions in the list of keyframes.
struct KeyframeWindow {
  std::vector<int> members;  ///< optimised with their poses, oldest first; the last is the current one
  int fixed = 0;             ///< the oldest member: its pose is held (gauge)
};

/// The window of `size` keyframes of the newest one, `current` (paper section 3.4): itself, the one before
/// it, and those of `near` (see nearest_keyframes()) of the highest `score`; none whose score is not
/// positive.
KeyframeWindow select_window(int current, const std::vector<int>& near, int size,
                             const std::function<double(int)>& score);

/// The order in which `steps` mapping steps visit keyframes: cycles through the window, each followed by
/// `past` keyframes drawn at random from the others of `near`, against forgetting. Positions in the list of
/// keyframes.
std::vector<int> mapping_order(const KeyframeWindow& window, std::vector<int> near, int steps, int past,
                               std::mt19937& random);

}  // namespace surefield
