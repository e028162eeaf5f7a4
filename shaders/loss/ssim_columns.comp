#version 460
#extension GL_GOOGLE_include_directive : require
#include "ssim_columns.h"
#include "ssim.glsl"

// One invocation per strip of STRIP pixels of a column; neighbouring invocations take neighbouring columns.
void main() {
  const uint strips = (params.height + STRIP - 1) / STRIP;
  const uint i = gl_GlobalInvocationID.x;
  if (i >= strips * params.width) return;
  const uint column = i % params.width;
  const int first = int(i / params.width) * STRIP;

  SsimMoments m[STRIP];
  [[unroll]] for (int o = 0; o < STRIP; ++o) m[o] = SsimMoments(0.0, 0.0, 0.0, 0.0);
  [[unroll]] for (int p = 0; p < STRIP + 2 * WINDOW_RADIUS; ++p) {
    const int row = first + p - WINDOW_RADIUS;
    const bool inside = row >= 0 && row < int(params.height);
    const SsimMoments s = moments[uint(clamp(row, 0, int(params.height) - 1)) * params.width + column];
    [[unroll]] for (int o = 0; o < STRIP; ++o) {
      if (p < o || p > o + 2 * WINDOW_RADIUS) continue;  // decided when the loops are unrolled
      const float w = inside ? WINDOW[p - o] : 0.0;
      m[o].x += w * s.x;
      m[o].y += w * s.y;
      m[o].squares += w * s.squares;
      m[o].xy += w * s.xy;
    }
  }
  float total = 0;
  [[unroll]] for (int o = 0; o < STRIP; ++o) {
    if (first + o >= int(params.height)) continue;
    const SsimMoments s = m[o];
    const float a1 = 2 * s.x * s.y + SSIM_C1, a2 = 2 * (s.xy - s.x * s.y) + SSIM_C2;
    const float b1 = s.x * s.x + s.y * s.y + SSIM_C1;
    const float b2 = s.squares - s.x * s.x - s.y * s.y + SSIM_C2;
    const float inverse = 1 / (b1 * b2);
    const float ssim = a1 * a2 * inverse;
    SsimSlopes g;
    g.x = 2 * s.y * (a2 - a1) * inverse - 2 * s.x * ssim * (1 / b1 - 1 / b2);
    g.xx = -ssim / b2;
    g.xy = 2 * a1 * inverse;
    const uint at = uint(first + o) * params.width + column;
    const float takes_part = sensor_depth[at] > 0 ? 1.0 : 0.0;
    slopes[at] = SsimSlopes(takes_part * g.x, takes_part * g.xx, takes_part * g.xy);
    total += takes_part * ssim;
  }
  ssim_partials[i] = total;
}
