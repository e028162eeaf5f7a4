#pragma once

#include <Eigen/Geometry>

namespace surefield {

/// Pinhole intrinsics in pixels. Pixel centres lie at integer coordinates (OpenCV): u = fx x / z + cx.
struct Intrinsics {
  int width = 0;
  int height = 0;
  double fx = 0;
  double fy = 0;
  double cx = 0;
  double cy = 0;

  /// The intrinsics of the image resized by `s`: f' = s f, c' = s (c + 0.5) - 0.5; sizes are rounded.
  Intrinsics scaled(double s) const;
};

/// A rigid transform. Unless a name says otherwise it maps world to camera: x_c = R x_w + t (metres),
/// right-handed, z forward, x right, y down.
using Pose = Eigen::Isometry3d;

/// A view of the scene: intrinsics and the world-to-camera pose.
struct Camera {
  Intrinsics intrinsics;
  Pose world_to_camera = Pose::Identity();
};

}  // namespace surefield
