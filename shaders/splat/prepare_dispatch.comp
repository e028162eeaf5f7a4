#version 460
#extension GL_GOOGLE_include_directive : require
#include "prepare_dispatch.h"

// A single invocation. At least one workgroup always runs: passes report their status even for an empty view.
void main() {
  if (gl_GlobalInvocationID.x != 0) return;
  dispatch_args[params.slot] = uvec3(max(1u, (element_count[0] + params.workgroup_size - 1) / params.workgroup_size), 1, 1);
}
