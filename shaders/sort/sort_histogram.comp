#version 460
#extension GL_GOOGLE_include_directive : require
#include "sort_histogram.h"
#include "chunks.glsl"

shared uint counters[SORT_DIGITS_MAX * gl_WorkGroupSize.x];

// Each invocation counts the digits of one chunk of consecutive keys in a column of counters of its own, so that no
// atomics are needed, and stores the column in the table.
void main() {
  const uint n = min(count[0], params.capacity);
  const uint chunk = chunk_length(n, params.columns, CHUNK_LEAST);
  const uint worker = gl_GlobalInvocationID.x;
  const uint begin = min(worker * chunk, n);
  const uint end = min(begin + chunk, n);
  const uint digits = begin < end ? 1u << params.digit_bits : 0;  // no column for an empty chunk
  const uint mine = gl_LocalInvocationID.x;

  for (uint d = 0; d < digits; ++d) counters[d * gl_WorkGroupSize.x + mine] = 0;
  for (uint i = begin; i < end; ++i) {
    const uint digit = bitfieldExtract(keys[i], int(params.shift), int(params.digit_bits));
    ++counters[digit * gl_WorkGroupSize.x + mine];
  }
  for (uint d = 0; d < digits; ++d) table[d * params.columns + worker] = counters[d * gl_WorkGroupSize.x + mine];
}
