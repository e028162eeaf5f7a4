#version 460
#extension GL_GOOGLE_include_directive : require
#include "judge_gaussians.h"

// One invocation per Gaussian of the map. One that dominates no pixel now, as one whose opacity was taken does at first, is
// what it was: it may gain opacity again, and is judged when it dominates again.
void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= params.count) return;
  const UncertaintySum sum = sums[i];
  if (sum.pixels > 0)
    uncertainty[i] = (float(sum.high) * 4294967296.0 + float(sum.low)) / (UNCERTAINTY_STEPS * float(sum.pixels));
  if (!(uncertainty[i] > params.above)) return;
  atomicAdd(uncertain[0], 1u);
  if (sum.pixels == 0 || opacity_logits[i] <= params.logit) return;
  opacity_logits[i] = params.logit;
  opacity_logits_m[i] = 0;
  opacity_logits_v[i] = 0;
}
