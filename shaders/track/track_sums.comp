#version 460
#extension GL_GOOGLE_include_directive : require
#include "track_sums.h"

// One invocation per strip.
void main() {
  const uint strip = gl_GlobalInvocationID.x;
  if (strip * SUM_STRIP >= params.pixels) return;
  const vec2 limit = limits[0];
  TrackSums s = TrackSums(0.0, 0.0, 0.0, 0.0);
  [[unroll]] for (uint k = 0; k < SUM_STRIP; ++k) {
    const uint i = strip * SUM_STRIP + k;
    const vec2 residual = i < params.pixels ? residuals[i] : vec2(-1);
    const bool colour = residual.x >= 0 && residual.x < limit.x, depth = residual.y >= 0 && residual.y < limit.y;
    s.colour += colour ? residual.x : 0.0;
    s.colour_pixels += colour ? 1.0 : 0.0;
    s.depth += depth ? residual.y : 0.0;
    s.depth_pixels += depth ? 1.0 : 0.0;
  }
  partial_sums[strip] = s;
}
