#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <utility>

#include "engine/viewer/overlays.h"

namespace surefield {

/// One frame's numbers, for plots.
struct FrameNumbers {
  float loss = 0;
  float frames_per_second = 0;
  float gaussians = 0;
  float ate_cm = 0;  ///< of the trajectory so far, where the truth is known
};

/// A frame of the sensor with its pose.
struct SceneFrame {
  int index = -1;  ///< in the sequence; -1: none
  Camera camera;   ///< with the intrinsics of its images
  cv::Mat colour;  ///< CV_8UC3, RGB; empty where there is none
  cv::Mat depth;   ///< CV_32FC1, metres
};

/// What a viewer shows beside the map: what is known of a run so far.
struct ViewerScene {
  Trajectory trajectory;  ///< camera to world
  Trajectory truth;       ///< moved into the world of the trajectory; empty: unknown
  Trajectory keyframes;
  std::vector<int> window;  ///< positions in `keyframes` that were optimised together last
  /// Pairs of positions in `keyframes` that are known to see one place, which the camera came back to.
  std::vector<std::pair<int, int>> loops;
  SceneFrame frame;  ///< the newest, or the one that was chosen
  std::vector<FrameNumbers> numbers;
  std::string status;       ///< one line
  std::string waiting_for;  ///< one line: what is done while there is no map yet
};

/// Which lines are drawn.
struct OverlayChoice {
  bool trajectory = true;
  bool truth = true;
  bool keyframes = true;
  bool window = true;  ///< its frusta, and the links from its newest keyframe to the others
  bool loops = true;   ///< a link for each
  bool camera = true;
  double frustum = 0.08;  ///< metres
  bool on_top = false;    ///< also what the map hides

  /// Of a keyframe, metres.
  double keyframe_frustum() const { return 0.7 * frustum; }

  bool operator==(const OverlayChoice&) const = default;
};

/// The lines of a scene, whose cameras have the intrinsics of its frame.
std::vector<Line> lines_of(const ViewerScene& scene, const OverlayChoice& choice);

}  // namespace surefield
