#version 460
#extension GL_GOOGLE_include_directive : require
#include "compact_visible.h"

// One invocation per Gaussian of the map; a visible one writes its index and its depth to its place in the list. The
// bits of positive floats sort like the floats.
void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= params.count || visible_flags[i] == 0) return;
  const uint slot = visible_offsets[i];
  depth_keys[slot] = floatBitsToUint(splats[i].depth);
  visible_ids[slot] = i;
  depth_order[slot] = i;
}
