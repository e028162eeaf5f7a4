#version 460
#extension GL_GOOGLE_include_directive : require
#include "sort_offsets.h"

shared uint scratch[gl_WorkGroupSize.x];
#define WORKGROUP_SCAN_SCRATCH scratch
#include "chunks.glsl"
#include "workgroup_scan.glsl"

// One workgroup per digit, that is per row of the table. Its invocations share out the columns in use: each sums a
// consecutive part of the row, learns from those before it where the part starts, and writes the running sum.
void main() {
  const uint n = min(count[0], params.capacity);
  const uint chunk = chunk_length(n, params.columns, CHUNK_LEAST);
  const uint used = (n + chunk - 1) / chunk;
  const uint row = gl_WorkGroupID.x * params.columns;
  const uint part = chunk_length(used, gl_WorkGroupSize.x, 1);
  const uint begin = min(gl_LocalInvocationID.x * part, used);
  const uint end = min(begin + part, used);
  uint sum = 0;
  for (uint w = begin; w < end; ++w) sum += table[row + w];

  uint total;
  uint running = workgroup_exclusive_scan(sum, total);
  for (uint w = begin; w < end; ++w) {
    const uint here = table[row + w];
    table[row + w] = running;
    running += here;
  }
  if (gl_LocalInvocationID.x == 0) digit_totals[gl_WorkGroupID.x] = total;
}
