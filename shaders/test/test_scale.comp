#version 460
#extension GL_GOOGLE_include_directive : require
#include "test_scale.h"

// One invocation per value.
void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= params.count) return;
  for (uint r = 0; r < REPEATS; ++r) values[i] = params.factor * values[i] + offsets[i];
}
