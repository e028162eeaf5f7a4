#version 460
#extension GL_GOOGLE_include_directive : require
#include "reduce_pose.h"

shared PoseGradient sums[gl_WorkGroupSize.x];

// One workgroup: every invocation adds up each gl_WorkGroupSize.x-th partial, then a tree adds the sums. The order of
// additions is fixed.
void main() {
  const uint i = gl_LocalInvocationID.x;
  const uint visible_groups = max(1u, (visible_count[0] + params.workgroup_size - 1) / params.workgroup_size);
  const uint count = params.count > 0 ? params.count : visible_groups * params.subgroups;
  PoseGradient sum = PoseGradient(vec3(0), vec3(0));
  for (uint k = i; k < count; k += gl_WorkGroupSize.x) {
    sum.rotation += pose_partials[k].rotation;
    sum.translation += pose_partials[k].translation;
  }
  sums[i] = sum;
  for (uint step = gl_WorkGroupSize.x / 2; step > 0; step /= 2) {
    barrier();
    if (i < step) {
      sums[i].rotation += sums[i + step].rotation;
      sums[i].translation += sums[i + step].translation;
    }
  }
  if (i == 0) pose_gradient[0] = sums[0];
}
