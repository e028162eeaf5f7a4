#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

namespace surefield {

/// The convex bodies that scenes are made of. A box fills its half sizes, an ellipsoid has them as semi-axes,
/// a cylinder stands along the third axis and is closed at both ends.
enum class ShapeKind { Box, Ellipsoid, Cylinder };

/// What the base colour of a material is modulated by.
enum class Pattern {
  Plain,   ///< noise of six octaves and a grid of cells: planks, bricks, tiles, books
  Poster,  ///< a picture over lines of text
  View,    ///< sky over hills, as through a window
  Screen,  ///< lines of text on a monitor
};

/// A procedural material. Colours are linear RGB. See shaders/lib/scene_textures.glsl for what the numbers
/// do.
struct Material {
  Eigen::Vector3f first = Eigen::Vector3f::Zero();
  Eigen::Vector3f second = Eigen::Vector3f::Zero();
  Eigen::Vector3f noise_frequency = Eigen::Vector3f::Constant(3);  ///< 1/m, of the coarsest octave
  float noise_contrast = 0;  ///< 1: noise goes all the way from the first to the second colour
  float noise_decay = 0.7f;  ///< weight of an octave relative to the one before it
  Eigen::Vector2f cell = Eigen::Vector2f::Ones();  ///< metres
  float cell_shift = 0;                            ///< of each row relative to the one below, in cells
  float cell_contrast = 0;  ///< 1: cells go all the way from the first to the second colour
  float cell_hue = 0;       ///< 1: each cell has a colour of its own
  float joint = 0;          ///< metres, the dark line between cells
  float gloss = 0;
  float shininess = 20;
  float emission = 0;  ///< part of the colour that shines by itself
  Pattern pattern = Pattern::Plain;

  /// Whether it has no texture at all, as a blank wall.
  bool is_blank() const;
  /// Roughly the mean over the surface, linear RGB.
  Eigen::Vector3f mean_colour() const;
};

/// A body of the scene. World frame: metres, z up.
struct Shape {
  ShapeKind kind = ShapeKind::Box;
  Eigen::Isometry3d shape_to_world = Eigen::Isometry3d::Identity();  ///< the origin is the centre
  Eigen::Vector3d half_size = Eigen::Vector3d::Ones();               ///< metres, along the axes of the shape
  Eigen::Vector3d texture_origin = Eigen::Vector3d::Zero();          ///< world
  int material = 0;                                                  ///< of Scene::materials
  int object = 0;                                                    ///< of Scene::objects
  uint32_t texture = 0;      ///< bodies of the same number have the same texture; 0: one of its own
  bool casts_shadow = true;  ///< lamps do not

  /// World offsets from the centre to unit coordinates, where a box is the cube from -1 to 1 and an ellipsoid
  /// the unit ball.
  Eigen::Matrix3d to_unit() const;
  /// Distance from a point to the body, metres, 0 inside; of an ellipsoid or a cylinder that to its box,
  /// which is smaller.
  double distance(const Eigen::Vector3d& point) const;
  /// At a point of the surface; world, unit length.
  Eigen::Vector3d outward_normal(const Eigen::Vector3d& point) const;
};

/// A point light with shadows. Its light falls off smoothly and ends at `range` metres.
struct Light {
  Eigen::Vector3d position;
  Eigen::Vector3f colour;  ///< linear RGB
  double range = 8;
};

/// A stop of the walks through a scene: where the camera passes and what it looks at then, world metres.
struct Waypoint {
  Eigen::Vector3d position;
  Eigen::Vector3d look;
};

/// A body that walks: its shapes are given in its own frame, whose z axis is up.
struct MovingObject {
  std::vector<Shape> shapes;
  std::vector<Eigen::Vector2d> track;  ///< closed polygon on the floor, metres
  double speed = 0.5;                  ///< metres a second

  /// The frame of the object, to the world, so many seconds after the start; it faces where it goes.
  Eigen::Isometry3d pose(double seconds) const;
};

/// A furnished place, the same on every machine for the same seed.
struct Scene {
  std::string name;
  std::vector<Shape> shapes;
  std::vector<Material> materials;
  std::vector<Light> lights;
  std::vector<std::string> objects;  ///< what each object is: "wall", "chair", ...
  std::vector<Waypoint> circuit;     ///< a closed walk on which nothing is nearer than 0.35 m
  int first_stop = -1;               ///< of the circuit, where walks begin; -1: the path's seed says where
  MovingObject visitor;              ///< somebody who may walk about

  /// Distance from a point to the nearest body, metres.
  double clearance(const Eigen::Vector3d& point) const;
};

/// The kinds of scenes by name: office, apartment, corridor, hall, twins.
std::vector<std::string> scene_names();

/// Builds the scene of that name. The seed varies furniture, colours and textures. Throws InputError for an
/// unknown name.
Scene make_scene(const std::string& name, uint32_t seed);

}  // namespace surefield
