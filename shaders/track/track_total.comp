#version 460
#extension GL_GOOGLE_include_directive : require
#include "track_total.h"

shared TrackSums tree[gl_WorkGroupSize.x];

TrackSums add(TrackSums a, TrackSums b) {
  return TrackSums(a.colour + b.colour, a.colour_pixels + b.colour_pixels, a.depth + b.depth,
                   a.depth_pixels + b.depth_pixels);
}

// One workgroup: strided sums, then a tree, always in the same order.
void main() {
  const uint i = gl_LocalInvocationID.x;
  TrackSums sum = TrackSums(0.0, 0.0, 0.0, 0.0);
  for (uint k = i; k < params.count; k += gl_WorkGroupSize.x) sum = add(sum, partial_sums[k]);
  tree[i] = sum;
  for (uint step = gl_WorkGroupSize.x / 2; step > 0; step /= 2) {
    barrier();
    if (i < step) tree[i] = add(tree[i], tree[i + step]);
  }
  if (i == 0) sums[0] = tree[0];
}
