#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace surefield {

/// A reproducible random number in [0, 1) that depends only on the lattice point and the seed.
float lattice_noise(int x, int y, uint32_t seed);

/// The base layout of a material; see Material.
enum class Pattern {
  Plaster,  ///< soft blotches
  Checks,   ///< a chess board
  Stripes,  ///< bands along v, soft on one side
  Wood,     ///< boards along u with grain
  Bricks,   ///< staggered rectangles with joints
  Poster,   ///< coloured patches with rings
};

/// A procedural texture: a pattern of two colours, on which finer grain lies so that every surface has detail
/// at several scales.
struct Material {
  Pattern pattern = Pattern::Plaster;
  Eigen::Vector3f first = Eigen::Vector3f::Zero();   ///< display RGB, 0 to 1
  Eigen::Vector3f second = Eigen::Vector3f::Zero();  ///< display RGB, 0 to 1
  float scale = 1;                                   ///< size of one repetition of the pattern, metres
  uint32_t seed = 0;
};

/// The unlit colour (display RGB, 0 to about 1.2) of `material` at the surface coordinates `uv`, in metres.
Eigen::Vector3f texture(const Material& material, const Eigen::Vector2f& uv);

}  // namespace surefield
