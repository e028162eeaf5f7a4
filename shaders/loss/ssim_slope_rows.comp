#version 460
#extension GL_GOOGLE_include_directive : require
#include "ssim_slope_rows.h"
#include "ssim.glsl"

// One invocation per strip of STRIP pixels of a row, as in ssim_rows.
void main() {
  const uint strips = (params.width + STRIP - 1) / STRIP;
  const uint strip = gl_GlobalInvocationID.x;
  if (strip >= strips * params.height) return;
  const int first = int(strip % strips) * STRIP;
  const uint row = strip / strips * params.width;

  SsimSlopes g[STRIP];
  [[unroll]] for (int o = 0; o < STRIP; ++o) g[o] = SsimSlopes(0.0, 0.0, 0.0);
  [[unroll]] for (int p = 0; p < STRIP + 2 * WINDOW_RADIUS; ++p) {
    const int column = first + p - WINDOW_RADIUS;
    const bool inside = column >= 0 && column < int(params.width);
    const SsimSlopes s = slopes[row + uint(clamp(column, 0, int(params.width) - 1))];
    [[unroll]] for (int o = 0; o < STRIP; ++o) {
      if (p < o || p > o + 2 * WINDOW_RADIUS) continue;  // decided when the loops are unrolled
      const float w = inside ? WINDOW[p - o] : 0.0;
      g[o].x += w * s.x;
      g[o].xx += w * s.xx;
      g[o].xy += w * s.xy;
    }
  }
  [[unroll]] for (int o = 0; o < STRIP; ++o)
    if (first + o < int(params.width)) row_slopes[row + uint(first + o)] = g[o];
}
