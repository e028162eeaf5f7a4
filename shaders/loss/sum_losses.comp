#version 460
#extension GL_GOOGLE_include_directive : require
#include "sum_losses.h"

shared LossSums sums[gl_WorkGroupSize.x];

LossSums add(LossSums a, LossSums b) {
  return LossSums(a.colour + b.colour, a.ssim + b.ssim, a.depth + b.depth, a.align + b.align, a.variance + b.variance,
                  a.medians + b.medians);
}

// One workgroup: strided sums, then a tree, always in the same order.
void main() {
  const uint i = gl_LocalInvocationID.x;
  LossSums sum = LossSums(0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
  for (uint k = i; k < params.count; k += gl_WorkGroupSize.x) sum = add(sum, loss_partials[k]);
  sums[i] = sum;
  for (uint step = gl_WorkGroupSize.x / 2; step > 0; step /= 2) {
    barrier();
    if (i < step) sums[i] = add(sums[i], sums[i + step]);
  }
  if (i == 0) loss[0] = sums[0];
}
