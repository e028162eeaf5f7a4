#version 460
#extension GL_GOOGLE_include_directive : require
#include "track_limits.h"

shared uint chunk_counts[gl_WorkGroupSize.x];

/// Median of one histogram, interpolated in its bin (of 1/64 octave); every invocation must call it.
float median_of(uint first) {
  const uint chunk = RESIDUAL_BINS / gl_WorkGroupSize.x;
  const uint i = gl_LocalInvocationID.x;
  uint count = 0;
  for (uint b = 0; b < chunk; ++b) count += histograms[first + i * chunk + b];
  barrier();
  chunk_counts[i] = count;
  barrier();
  uint total = 0;
  for (uint k = 0; k < gl_WorkGroupSize.x; ++k) total += chunk_counts[k];
  if (total == 0) return 0;
  const uint rank = (total - 1) / 2;   // of the lower one in the middle
  uint before = 0, found = 0;
  for (uint k = 0; k < gl_WorkGroupSize.x; ++k) {
    if (before + chunk_counts[k] > rank) break;
    before += chunk_counts[k];
    ++found;
  }
  uint bin = found * chunk;
  for (uint b = 0; b < chunk; ++b) {
    if (before + histograms[first + bin] > rank) break;
    before += histograms[first + bin];
    ++bin;
  }
  const float inside = (float(rank - before) + 0.5) / float(max(histograms[first + bin], 1u));
  return exp2((float(bin) + inside) / RESIDUAL_BINS_PER_OCTAVE - 20);
}

// One workgroup of a size that divides RESIDUAL_BINS.
void main() {
  [[dont_unroll]] for (uint which = 0; which < 2; ++which) {
    const float median = median_of(which * RESIDUAL_BINS);
    if (gl_LocalInvocationID.x == 0) limits[0][which] = params.outlier_factor * median;
  }
}
