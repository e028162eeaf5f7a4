#version 460
#extension GL_GOOGLE_include_directive : require
#include "measure_peak.h"

// Every invocation advances PEAK_CHAINS independent values, ROUNDS times each, in registers: by a multiply-add, or by an
// exponential. The values depend on parameters and are stored in the end, so that no compiler can leave the work out.
const uint PEAK_CHAINS = 16;

void main() {
  float value[PEAK_CHAINS];
  [[unroll]] for (uint k = 0; k < PEAK_CHAINS; ++k) value[k] = params.offset * float(k + gl_LocalInvocationID.x);
  for (uint round = 0; round < ROUNDS; ++round) {
    [[unroll]] for (uint k = 0; k < PEAK_CHAINS; ++k)
      value[k] = EXPONENTIALS == 1 ? exp(-value[k]) : value[k] * params.factor + params.offset;
  }
  float sum = 0;
  [[unroll]] for (uint k = 0; k < PEAK_CHAINS; ++k) sum += value[k];
  results[gl_GlobalInvocationID.x] = sum;
}
