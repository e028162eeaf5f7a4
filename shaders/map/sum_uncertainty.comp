#version 460
#extension GL_GOOGLE_include_directive : require
#include "sum_uncertainty.h"
#include "depth_noise.glsl"

const float LARGEST_ERROR = 4;   // standard deviations of the sensor that do not make a Gaussian uncertain

// One invocation per pixel. Sums are whole numbers, so they are the same in whatever order pixels come; 64 bits hold 2^32
// pixels of the largest term.
void main() {
  const uint p = gl_GlobalInvocationID.x;
  if (p >= params.pixels || status[0].overflow != 0) return;
  const uint id = dominators[p];
  const float measured = sensor_depth[p];
  if (!(measured > 0) || id == 0xFFFFFFFFu) return;
  const float allowed = LARGEST_ERROR * sigma_at(params.noise, measured);
  // Far away the sensor itself is off by more than what is judged uncertain.
  const float off = (measured - splats[id].depth) * min(1.0, sqrt(params.above) / allowed);
  const uint steps = uint(min(geometry[p].w * off * off, LARGEST_UNCERTAINTY) * UNCERTAINTY_STEPS + 0.5);
  const uint before = atomicAdd(sums[id].low, steps);
  if (before + steps < before) atomicAdd(sums[id].high, 1u);
  atomicAdd(sums[id].pixels, 1u);
}
