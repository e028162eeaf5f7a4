#pragma once

#include <string>
#include <vector>

#include "engine/synth/random.h"
#include "engine/synth/scene.h"

namespace surefield {

/// Where a piece of furniture stands: the middle of its footprint, metres, and how far it is turned about the
/// vertical axis, degrees. At 0 degrees its front faces the negative y direction.
struct Spot {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  double turn = 0;
};

/// Puts bodies into a scene. Positions are in the frame of the object that was begun last.
class SceneBuilder {
 public:
  SceneBuilder(std::string name, uint32_t seed);

  RandomStream random;

  /// Adds a material and returns its number.
  int material(const Material& material);

  /// Everything until the next call belongs to one object that stands at `spot`.
  void begin(const std::string& object, const Spot& spot = {});

  /// A box on its bottom face; `bottom` is the middle of that face.
  void box(const Eigen::Vector3d& bottom, const Eigen::Vector3d& size, int material, double turn = 0);
  /// An upright cylinder.
  void cylinder(const Eigen::Vector3d& bottom, double radius, double height, int material);
  /// A thin cylinder from one point to another.
  void rod(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius, int material);
  void ellipsoid(const Eigen::Vector3d& centre, const Eigen::Vector3d& half_size, int material);
  /// A flat ellipsoid that is longest along `along` and faces `up` as far as that allows.
  void leaf(const Eigen::Vector3d& centre, const Eigen::Vector3d& half_size, const Eigen::Vector3d& along,
            const Eigen::Vector3d& up, int material);

  /// A box between two corners of the world whose texture goes on from one such box to the next.
  void wall(const Eigen::Vector3d& low, const Eigen::Vector3d& high, int material);

  /// The last body casts no shadow, as it surrounds a light.
  void no_shadow() { scene.shapes.back().casts_shadow = false; }

  /// The spot of something that stands on this object at `local`.
  Spot on_top(const Eigen::Vector3d& local, double turn) const;

  Scene scene;

 private:
  Shape& add(ShapeKind kind, const Eigen::Isometry3d& in_object, const Eigen::Vector3d& half_size,
             int material);

  Eigen::Isometry3d object_to_world_ = Eigen::Isometry3d::Identity();
  double object_turn_ = 0;
};

/// Linear RGB of a colour given as on the web, 0xRRGGBB.
Eigen::Vector3f linear_colour(uint32_t rgb);

}  // namespace surefield
