#version 460
#extension GL_GOOGLE_include_directive : require
#include "align_rendered.h"
#include "intensity.glsl"

// One invocation per pixel.
void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= params.pixels) return;
  const vec4 colour = colour_opacity[i];
  const float depth = NORMALISED_DEPTH == 1 ? geometry[i].x / max(colour.a, 1e-6) : geometry[i].x;
  image[i] = vec2(intensity_of(colour.rgb), colour.a > params.minimum_opacity ? depth : 0.0);
}
