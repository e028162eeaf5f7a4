#pragma once

#include <cstdint>

/// The GLSL types that shaders/shared/ uses, in scalar block layout: vec3 is 12 bytes, everything aligns
/// to 4.
namespace surefield::glsl {

using uint = std::uint32_t;

struct vec2 {
  float x = 0, y = 0;
};
struct vec3 {
  float x = 0, y = 0, z = 0;
};
struct vec4 {
  float x = 0, y = 0, z = 0, w = 0;
};
struct uvec2 {
  uint x = 0, y = 0;
};
struct uvec3 {
  uint x = 0, y = 0, z = 0;
};
struct uvec4 {
  uint x = 0, y = 0, z = 0, w = 0;
};

}  // namespace surefield::glsl
