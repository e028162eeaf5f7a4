#version 460
#extension GL_GOOGLE_include_directive : require
#include "resample_sensor.h"

// One invocation per pixel of the view: takes the nearest pixel of the sensor, since depths must not be mixed.
void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= params.size.x * params.size.y) return;
  const vec2 pixel = vec2(i % params.size.x, i / params.size.x);
  const ivec2 source = ivec2(floor(params.scale * pixel + params.offset + 0.5));
  const bool inside = all(greaterThanEqual(source, ivec2(0))) && all(lessThan(source, ivec2(params.sensor_size)));
  const uint at = inside ? uint(source.y) * params.sensor_size.x + uint(source.x) : 0;
  colour[i] = inside ? sensor_colour[at] : 0;
  depth[i] = inside ? sensor_depth[at] : 0;
}
