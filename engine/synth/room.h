#pragma once

#include <cstdint>
#include <vector>

#include "engine/io/frame.h"
#include "engine/splat/camera.h"
#include "engine/synth/textures.h"

namespace surefield {

/// Where a ray meets the scene.
struct SurfacePoint {
  double distance = 0;                               ///< in lengths of the ray's direction
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit length, towards the ray's origin
  Eigen::Vector2f uv = Eigen::Vector2f::Zero();      ///< texture coordinates, metres
  const Material* material = nullptr;
};

/// A furnished box room with procedural textures and one lamp, ray cast on the CPU: colour and depth as an
/// ideal RGB-D camera would see them. World frame: metres, z up, the floor's corner at the origin, size() the
/// opposite corner. The same seed gives the same bits on every run.
class SyntheticRoom {
 public:
  /// `seed` varies the textures and the place where the camera path starts; the furniture stays.
  explicit SyntheticRoom(uint32_t seed = 1);

  /// Length, width and height of the room, metres.
  static Eigen::Vector3d size() { return {5.0, 4.0, 2.7}; }

  /// A smooth hand-held walk around the room's middle, about 0.3 m/s and 15 degrees/s; world to camera,
  /// `seconds` from its start. Endless: it returns to about where it began after some 26 s.
  Pose world_to_camera(double seconds) const;

  /// The first surface along origin + distance * direction (world frame). `origin` must be inside the room
  /// and outside the furniture; then there always is one.
  SurfacePoint cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;

  /// The frame that `camera` sees, with index and timestamp 0. Depth is exact camera z at the pixel centres;
  /// colour is the mean of 2 x 2 samples a pixel. Every pixel is valid. Uses all cores.
  Frame render(const Camera& camera) const;

 private:
  /// A box turned about the vertical axis, seen from outside.
  struct Box {
    Eigen::Vector3d centre, half_size;
    double cos_yaw, sin_yaw;
    Material material;
  };
  struct Sphere {
    Eigen::Vector3d centre;
    double radius;
    Material material;
  };

  void add_box(const Eigen::Vector3d& lowest_centre, const Eigen::Vector3d& box_size, double yaw_degrees,
               Material material);
  void add_table();
  void add_furniture();
  void add_posters();
  void hit_walls(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                 SurfacePoint* nearest) const;
  static void hit_box(const Box& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                      SurfacePoint* nearest);
  static void hit_sphere(const Sphere& sphere, const Eigen::Vector3d& origin,
                         const Eigen::Vector3d& direction, SurfacePoint* nearest);
  Eigen::Vector3f shade(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;

  uint32_t seed_;
  Material walls_[6];  ///< low x, high x, low y, high y, floor, ceiling
  std::vector<Box> boxes_;
  std::vector<Sphere> spheres_;
};

}  // namespace surefield
