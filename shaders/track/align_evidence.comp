#version 460
#extension GL_GOOGLE_include_directive : require
#include "align_evidence.h"
#include "align_total.glsl"

// One workgroup.
void main() {
  const uint i = gl_LocalInvocationID.x;
  for (uint part = 0; part < params.parts; ++part) {
    const AlignSums sum = total(i, part, params.count);
    if (i == 0) evidence[part] = sum;
    barrier();
  }
}
