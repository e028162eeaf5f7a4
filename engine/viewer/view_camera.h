#pragma once

#include "engine/types/camera.h"

namespace surefield {

/// The camera of a person who looks at a map: moved by hand, behind the tracked camera, or in its place.
///
/// Up is the world's -y, as the first camera of a run was held, until set_up() says more.
class ViewCamera {
 public:
  /// Where up is in the world (find_up()), unit length. Changes no pose that is already taken.
  void set_up(const Eigen::Vector3d& up) { down_ = -up; }
  Eigen::Vector3d up() const { return -down_; }
  /// Behind the pose of a tracked camera, slightly above it, looking where it looks.
  void follow(const Pose& camera_to_world);
  /// In the place of a camera, with its field of view.
  void look_through(const Camera& camera);
  /// From behind so that a scene around `middle` of this size (metres) is seen.
  void overlook(const Eigen::Vector3d& middle, double size);

  /// Turns around the point that is looked at; radians.
  void orbit(double right, double down);
  /// Turns on the spot; radians.
  void turn(double right, double down);
  /// Moves along its own axes (x right, y down, z forward), metres.
  void move(const Eigen::Vector3d& along);
  /// Moves the point that is looked at with the camera, by pixels of an image that is `height` pixels high.
  void pan(double right, double down, int height);
  /// Comes closer to the point that is looked at, by this factor of the distance.
  void approach(double factor);

  /// The camera for a picture of this size: what its field of view holds is seen whole.
  Camera camera(int width, int height) const;
  const Pose& camera_to_world() const { return pose_; }
  double distance() const { return distance_; }

 private:
  Eigen::Vector3d down_ = Eigen::Vector3d::UnitY();
  Pose pose_ = Pose::Identity();  ///< camera to world
  double distance_ = 1.5;         ///< of the point that is looked at, metres
  Intrinsics lens_{.width = 4, .height = 3, .fx = 3.5, .fy = 3.5, .cx = 1.5, .cy = 1};
};

}  // namespace surefield
