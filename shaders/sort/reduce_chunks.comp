#version 460
#extension GL_GOOGLE_include_directive : require
#include "reduce_chunks.h"
#include "chunks.glsl"

// Each invocation sums one chunk of consecutive values, first to last. The chunks depend on the number of values
// alone, not on the dispatch: invocations beyond the last chunk have nothing to do.
void main() {
  const uint n = min(count[0], params.capacity);
  const uint chunk = chunk_length(n, REDUCE_CHUNKS, REDUCE_CHUNK_LEAST);
  const uint begin = gl_GlobalInvocationID.x * chunk;
  if (begin >= n) return;
  const uint end = min(begin + chunk, n);
  precise float sum = 0.0;
  for (uint i = begin; i < end; ++i) sum += values[i];
  partial_sums[gl_GlobalInvocationID.x] = sum;
}
