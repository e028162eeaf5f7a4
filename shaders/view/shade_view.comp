#version 460
#extension GL_GOOGLE_include_directive : require
#include "shade_view.h"

vec3 unpack(uint rgba) {
  return unpackUnorm4x8(rgba).rgb;
}

/// The palette's colour of a value between low and high.
vec3 painted(float value) {
  const float t = (value - params.low) / (params.high - params.low);
  return unpack(palette[uint(clamp(t, 0.0, 1.0) * 255 + 0.5)]);
}

/// The sensor's image in dim grey, and the palette's colours over it where the render differs.
vec3 error_overlay(vec3 rendered, vec3 sensor) {
  const vec3 off = abs(rendered - sensor);
  const float weight = min((off.r + off.g + off.b) / (3 * FULL_ERROR), 1.0);
  const float grey = 0.4 * dot(sensor, vec3(0.299, 0.587, 0.114));
  return mix(vec3(grey), unpack(palette[uint(weight * 255 + 0.5)]), weight);
}

/// What is behind the map: two tones of the background in squares, so that a hole is no black thing.
vec3 behind_at(uint i) {
  if (params.checker == 0) return params.background;
  const uvec2 square = uvec2(i % params.width, i / params.width) / params.checker;
  return params.background + ((square.x + square.y) % 2) * CHECKER_CONTRAST;
}

// One invocation per pixel.
void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= params.pixels) return;
  const vec4 rendered = colour_opacity[i];
  const vec4 depths = geometry[i];
  const float opacity = rendered.a;
  const vec3 sensor = unpack(sensor_colour[i]);
  const bool sensed = sensor_colour[i] != 0;
  const vec3 behind = behind_at(i);
  const vec3 colour = clamp(rendered.rgb + (1 - opacity) * behind, 0.0, 1.0);
  const float per_opacity = opacity > 0 ? 1 / opacity : 0.0;

  vec3 shown = colour;
  if (SHADE == SHADE_DEPTH) shown = mix(behind, painted(depths.x * per_opacity), opacity);
  if (SHADE == SHADE_MEDIAN_DEPTH) shown = depths.y > 0 ? painted(depths.y) : behind;
  if (SHADE == SHADE_OPACITY) shown = vec3(opacity);
  if (SHADE == SHADE_UNCERTAINTY) shown = sensor_depth[i] > 0 ? painted(sqrt(max(depths.z, 0))) : behind;
  if (SHADE == SHADE_GAUSSIAN_UNCERTAINTY) shown = mix(behind, painted(sqrt(max(rendered.r * per_opacity, 0))), opacity);
  if (SHADE == SHADE_SENSOR) shown = sensed ? sensor : behind;
  if (SHADE == SHADE_ERROR) shown = sensed ? error_overlay(colour, sensor) : behind;
  picture[i] = packUnorm4x8(vec4(shown, 1));
}
