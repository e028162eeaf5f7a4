#pragma once

#include <random>
#include <vector>

#include "engine/io/frame.h"
#include "engine/splat/engine.h"

namespace surefield {

/// A frame that stays on the device for mapping.
struct Keyframe {
  int index = 0;         ///< Frame::index
  double timestamp = 0;  ///< seconds
  FrameHandle frame = 0;
  Camera camera;
  std::vector<Eigen::Vector3f> points;  ///< a coarse grid of its depth, camera frame, metres
};

/// A coarse grid of the valid depths of a frame, back-projected to the camera frame; for covisibility.
std::vector<Eigen::Vector3f> sample_points(const Frame& frame, const Intrinsics& intrinsics,
                                           double depth_max);

/// The fraction of the points of `from` that `to` sees inside its image: covisibility by geometric overlap,
/// in [0, 1].
double overlap(const Keyframe& from, const Keyframe& to);

/// The keyframes that one mapping call works on: positions in the list of keyframes.
struct KeyframeWindow {
  std::vector<int> members;  ///< optimised with their poses, oldest first; the last is the current one
  int fixed = 0;             ///< the oldest member: its pose is held (gauge)
};

/// The window of `size` keyframes of the newest one (paper section 3.4): itself, the one before it, and those
/// that overlap it most.
KeyframeWindow select_window(const std::vector<Keyframe>& keyframes, int size);

/// The order in which `steps` mapping steps visit keyframes: cycles through the window, each followed by
/// `past` keyframes drawn at random from all others, against forgetting. Positions in the list of keyframes.
std::vector<int> mapping_order(const KeyframeWindow& window, int keyframes, int steps, int past,
                               std::mt19937& random);

}  // namespace surefield
