#version 460
#extension GL_GOOGLE_include_directive : require
#include "align_sensor.h"
#include "intensity.glsl"

// One invocation per pixel.
void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= params.pixels) return;
  image[i] = vec2(intensity_of(unpackUnorm4x8(sensor_colour[i]).rgb), sensor_depth[i]);
}
