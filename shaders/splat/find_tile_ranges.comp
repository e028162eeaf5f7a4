#version 460
#extension GL_GOOGLE_include_directive : require
#include "find_tile_ranges.h"

// One invocation per instance: where its tile differs from its neighbour's, a range begins or ends. The ranges are
// cleared beforehand, so that tiles without instances are empty. The owners are put in the sorted order too: blending
// forward and backward then finds its Gaussians with one look-up less.
void main() {
  const uint i = gl_GlobalInvocationID.x;
  const uint count = instance_count[0];
  if (i >= count) return;
  tile_gaussians[i] = instance_owners[instances[i]];
  const uint tile = tile_keys[i];
  if (i == 0 || tile_keys[i - 1] != tile) tile_ranges[tile].x = i;
  if (i == count - 1 || tile_keys[i + 1] != tile) tile_ranges[tile].y = i + 1;
}
