#version 460
#extension GL_GOOGLE_include_directive : require
#include "measure_peak.h"

// Copies one entry; or advances PEAK_CHAINS independent values in registers, by a multiply-add or an exponential. The
// values depend on parameters and are stored in the end, so that no compiler can leave the work out.
void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (MEASURE == PEAK_COPY) {
    results[i] = source[i];
    return;
  }
  float value[PEAK_CHAINS];
  [[unroll]] for (uint k = 0; k < PEAK_CHAINS; ++k) value[k] = params.offset * float(k + gl_LocalInvocationID.x);
  for (uint round = 0; round < ROUNDS; ++round) {
    [[unroll]] for (uint step = 0; step < PEAK_UNROLLED; ++step)
      [[unroll]] for (uint k = 0; k < PEAK_CHAINS; ++k)
        value[k] = MEASURE == PEAK_EXPONENTIALS ? exp2(-value[k]) : fma(value[k], params.factor, params.offset);
  }
  float sum = 0;
  [[unroll]] for (uint k = 0; k < PEAK_CHAINS; ++k) sum += value[k];
  results[i] = vec4(sum);
}
