#version 460
#extension GL_GOOGLE_include_directive : require
#include "scan_sums.h"

shared uint scratch[gl_WorkGroupSize.x];
#define WORKGROUP_SCAN_SCRATCH scratch
#include "chunks.glsl"
#include "workgroup_scan.glsl"

// Each invocation sums one chunk of consecutive elements; the first of a workgroup writes the workgroup's sum.
void main() {
  const uint n = min(count[0], params.capacity);
  const uint chunk = chunk_length(n, gl_NumWorkGroups.x * gl_WorkGroupSize.x, 1);
  const uint begin = min(gl_GlobalInvocationID.x * chunk, n);
  const uint end = min(begin + chunk, n);
  uint sum = 0;
  for (uint i = begin; i < end; ++i) sum += values[i];
  uint total_of_group;
  workgroup_exclusive_scan(sum, total_of_group);
  if (gl_LocalInvocationID.x == 0) group_sums[gl_WorkGroupID.x] = total_of_group;
}
