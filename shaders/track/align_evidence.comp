#version 460
#extension GL_GOOGLE_include_directive : require
#include "align_evidence.h"
#include "align_total.glsl"

// One workgroup.
void main() {
  const uint i = gl_LocalInvocationID.x;
  for (uint part = 0; part < params.parts; ++part) {
    const float sum = total(part, params.count);
    if (i < ALIGN_VALUES) evidence[part * ALIGN_VALUES + i] = floatBitsToUint(sum);
  }
}
