#version 460
#extension GL_GOOGLE_include_directive : require
#include "track_residuals.h"
#include "depth_noise.glsl"

const float DEVIATIONS = 3;          // of the sensor, within which the render explains a depth
const float LEAST_EXPLAINED = 0.02;  // metres; what the map itself is off at least
const float LEAST_THROUGH = 0.05;    // metres

uint bin_of(float residual) {
  const float octave = log2(max(residual, exp2(-20.0))) + 20;
  return min(uint(octave * RESIDUAL_BINS_PER_OCTAVE), RESIDUAL_BINS - 1);
}

// One invocation per pixel. Only pixels that the map covers (O above the threshold) take part, in the depth term only
// those with sensor depth. Counting into bins is exact in any order.
void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= params.pixels) return;
  const vec4 image = colour_opacity[i];
  const float sensor = sensor_depth[i];
  const bool covered = image.a > params.minimum_opacity;
  const vec3 off = abs(image.rgb - unpackUnorm4x8(sensor_colour[i]).rgb);
  const float depth = NORMALISED_DEPTH == 1 ? geometry[i].x / max(image.a, 1e-6) : geometry[i].x;
  const vec2 residual = vec2(covered ? (off.r + off.g + off.b) / 3 : -1.0,
                             covered && sensor > 0 ? abs(depth - sensor) : -1.0);
  residuals[i] = residual;
  if (residual.x >= 0) atomicAdd(histograms[bin_of(residual.x)], 1);
  if (residual.y < 0) return;
  atomicAdd(histograms[RESIDUAL_BINS + bin_of(residual.y)], 1);
  const float expected = DEVIATIONS * sigma_at(params.noise, sensor);
  if (residual.y < max(expected, LEAST_EXPLAINED)) atomicAdd(histograms[RESIDUAL_EXPLAINED], 1);
  if (sensor - depth > max(expected, LEAST_THROUGH)) atomicAdd(histograms[RESIDUAL_THROUGH], 1);
}
