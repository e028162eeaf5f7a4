#version 460
#extension GL_GOOGLE_include_directive : require
#include "compact_visible.h"
#include "quaternion.glsl"
#include "projection.glsl"

/// The bits of positive floats sort like the floats. Counted from those of the near plane they need fewer digits, and the
/// last ones tell apart less than a hundredth of a millimetre at a metre: without them a sort is one digit shorter.
uint depth_key(float depth) {
  const uint DROPPED = 6;
  const uint first = floatBitsToUint(NEAR_PLANE) >> DROPPED;
  return min((floatBitsToUint(depth) >> DROPPED) - first, (1u << DEPTH_KEY_BITS) - 1);
}

// One invocation per Gaussian of the map; a visible one writes its index and its depth to its place in the list.
void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= params.count || visible_flags[i] == 0) return;
  const uint slot = visible_offsets[i];
  depth_keys[slot] = depth_key(splats[i].depth);
  visible_ids[slot] = i;
  depth_order[slot] = i;
}
