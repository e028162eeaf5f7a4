#version 460
#extension GL_GOOGLE_include_directive : require
#include "reduce_total.h"
#include "chunks.glsl"

shared float lane_sums[REDUCE_LANES];

// One workgroup: lane l sums the chunks l, l + REDUCE_LANES, ... in order, then the lanes are summed pairwise.
void main() {
  const uint n = min(count[0], params.capacity);
  const uint chunk = chunk_length(n, REDUCE_CHUNKS, REDUCE_CHUNK_LEAST);
  const uint chunks = (n + chunk - 1) / chunk;
  const uint lane = gl_LocalInvocationID.x;
  precise float sum = 0.0;
  for (uint c = lane; c < chunks; c += REDUCE_LANES) sum += partial_sums[c];
  lane_sums[lane] = sum;
  barrier();
  for (uint half_lanes = REDUCE_LANES / 2; half_lanes > 0; half_lanes /= 2) {
    if (lane < half_lanes) {
      sum += lane_sums[lane + half_lanes];
      lane_sums[lane] = sum;
    }
    barrier();
  }
  if (lane == 0) result[0] = sum;
}
