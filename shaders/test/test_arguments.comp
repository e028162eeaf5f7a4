#version 460
#extension GL_GOOGLE_include_directive : require
#include "test_arguments.h"

// One invocation per entry.
void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i < params.count) args[i] = uvec3(params.groups, 1, 1);
}
