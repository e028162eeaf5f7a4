#version 460
#extension GL_GOOGLE_include_directive : require
#include "ssim_rows.h"
#include "intensity.glsl"
#include "ssim.glsl"

// One invocation per strip of STRIP pixels of a row: x counts strips of the whole image, row by row.
void main() {
  const uint strips = (params.width + STRIP - 1) / STRIP;
  const uint strip = gl_GlobalInvocationID.x;
  if (strip >= strips * params.height) return;
  const int first = int(strip % strips) * STRIP;
  const uint row = strip / strips * params.width;

  SsimMoments m[STRIP];
  [[unroll]] for (int o = 0; o < STRIP; ++o) m[o] = SsimMoments(0.0, 0.0, 0.0, 0.0);
  [[unroll]] for (int p = 0; p < STRIP + 2 * WINDOW_RADIUS; ++p) {
    const int column = first + p - WINDOW_RADIUS;
    const bool inside = column >= 0 && column < int(params.width);
    const uint at = row + uint(clamp(column, 0, int(params.width) - 1));
    const float mask = inside && sensor_depth[at] > 0 ? 1.0 : 0.0;
    const float x = mask * intensity_of(colour_opacity[at].rgb);
    const float y = mask * intensity_of(params.gains * unpackUnorm4x8(sensor_colour[at]).rgb);
    const float squares = x * x + y * y, xy = x * y;
    [[unroll]] for (int o = 0; o < STRIP; ++o) {
      if (p < o || p > o + 2 * WINDOW_RADIUS) continue;  // decided when the loops are unrolled
      const float w = WINDOW[p - o];
      m[o].x += w * x;
      m[o].y += w * y;
      m[o].squares += w * squares;
      m[o].xy += w * xy;
    }
  }
  uint medians = 0;
  [[unroll]] for (int o = 0; o < STRIP; ++o) {
    if (first + o >= int(params.width)) continue;
    const uint at = row + uint(first + o);
    moments[at] = m[o];
    medians += geometry[at].y > 0 ? 1 : 0;
  }
  atomicAdd(median_count[0], medians);
}
