#version 460
#extension GL_GOOGLE_include_directive : require
#include "scan_apply.h"

shared uint scratch[gl_WorkGroupSize.x];
#define WORKGROUP_SCAN_SCRATCH scratch
#include "chunks.glsl"
#include "workgroup_scan.glsl"

// Sum of the elements of all workgroups before this one, by all invocations together.
uint sum_before_group() {
  uint sum = 0;
  for (uint g = gl_LocalInvocationID.x; g < gl_WorkGroupID.x; g += gl_WorkGroupSize.x) sum += group_sums[g];
  uint total_before;
  workgroup_exclusive_scan(sum, total_before);
  return total_before;
}

// Each invocation takes the chunk that it took in scan_sums: it sums the chunk, learns from the workgroups and the
// invocations before it where the chunk starts, and writes the running sum. The last workgroup knows the total.
void main() {
  const uint n = min(count[0], params.capacity);
  const uint chunk = chunk_length(n, gl_NumWorkGroups.x * gl_WorkGroupSize.x, 1);
  const uint begin = min(gl_GlobalInvocationID.x * chunk, n);
  const uint end = min(begin + chunk, n);
  uint sum = 0;
  for (uint i = begin; i < end; ++i) sum += values[i];

  const uint before_group = sum_before_group();
  uint total_of_group;
  uint running = before_group + workgroup_exclusive_scan(sum, total_of_group);
  for (uint i = begin; i < end; ++i) {
    prefix_sums[i] = running;
    running += values[i];
  }
  if (gl_WorkGroupID.x == gl_NumWorkGroups.x - 1 && gl_LocalInvocationID.x == 0)
    total[0] = before_group + total_of_group;
}
