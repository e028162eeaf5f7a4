#pragma once

#include <algorithm>
#include <vector>

#include "engine/slam/moved_things.h"

namespace surefield::testing {

inline constexpr int kBoardWidth = 160, kBoardHeight = 120;
inline const Intrinsics kBoardCamera{kBoardWidth, kBoardHeight, 130, 130, 79.5, 59.5};
inline const DepthNoise kBoardNoise = noise_of(DepthSensor::StructuredLight);

/// Something flat that faces the camera, metres in the world.
struct Board {
  double left = 0, right = 0, top = 0, bottom = 0, z = 0;
};
inline constexpr Board kPerson{-0.3, 0.3, -0.6, 1, 1.5};

/// A keyframe at `x` before a wall 3 m away, with boards before it.
struct BoardView {
  ColourGrid grid;
  Camera camera{kBoardCamera, Pose::Identity()};

  explicit BoardView(double x, const std::vector<Board>& boards = {}) {
    camera.world_to_camera.translation().x() = -x;
    Frame frame;
    frame.colour = cv::Mat(kBoardHeight, kBoardWidth, CV_8UC3, cv::Scalar::all(90));
    frame.depth = cv::Mat(kBoardHeight, kBoardWidth, CV_32FC1, cv::Scalar(3));
    for (int v = 0; v < kBoardHeight; ++v)
      for (int u = 0; u < kBoardWidth; ++u)
        for (const Board& b : boards) {
          const double px = x + b.z * (u - kBoardCamera.cx) / kBoardCamera.fx,
                       py = b.z * (v - kBoardCamera.cy) / kBoardCamera.fy;
          auto& z = frame.depth.at<float>(v, u);
          if (px > b.left && px < b.right && py > b.top && py < b.bottom)
            z = std::min(z, static_cast<float>(b.z));
        }
    grid = make_colour_grid(frame);
  }
  DepthView depth() const { return {grid, camera}; }
};

}  // namespace surefield::testing
