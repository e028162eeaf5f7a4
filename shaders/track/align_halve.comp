#version 460
#extension GL_GOOGLE_include_directive : require
#include "align_halve.h"
#include "pyramid.glsl"

const float SAME_SURFACE = 0.05;   // of the depth

// One invocation per pixel of the smaller image: the mean of four; of their depths, those on the nearest surface.
// Where there is none, a pixel that is not to be compared (negative) makes the mean one too.
void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= params.width * params.height) return;
  const uvec2 pixel = pixel_at(i, params.width);
  const uint at = 2 * pixel.y * params.source_width + 2 * pixel.x;
  const vec2 four[4] = vec2[](source[at], source[at + 1], source[at + params.source_width],
                              source[at + params.source_width + 1]);
  float intensity = 0, nearest = 0, lowest = 0;
  [[unroll]] for (uint k = 0; k < 4; ++k) {
    intensity += 0.25 * four[k].x;
    lowest = min(lowest, four[k].y);
    if (four[k].y > 0) nearest = nearest > 0 ? min(nearest, four[k].y) : four[k].y;
  }
  float sum = 0, count = 0;
  [[unroll]] for (uint k = 0; k < 4; ++k)
    if (four[k].y > 0 && four[k].y <= (1 + SAME_SURFACE) * nearest) {
      sum += four[k].y;
      count += 1;
    }
  image[i] = vec2(intensity, count > 0 ? sum / count : lowest);
}
