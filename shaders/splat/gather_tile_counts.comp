#version 460
#extension GL_GOOGLE_include_directive : require
#include "gather_tile_counts.h"

// One invocation per visible Gaussian, in depth order.
void main() {
  const uint v = gl_GlobalInvocationID.x;
  if (v >= visible_count[0]) return;
  sorted_counts[v] = tile_counts[depth_order[v]];
}
