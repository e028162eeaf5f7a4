#version 460
#extension GL_GOOGLE_include_directive : require
#include "align_step.h"
#include "adam.glsl"
#include "align_total.glsl"
#include "pose.glsl"
#include "triangle.glsl"

// Of the residuals, so that perfect data do not divide by zero: of intensity, and of distance in standard deviations.
const float LEAST_COLOUR = 1e-8, LEAST_DEPTH = 0.01;
const float DAMPING = 1e-4;          // of the diagonal

shared float values[gl_WorkGroupSize.x];   // AlignSums of a source, at last of all

/// Solves the normal equations by Cholesky's decomposition; false where they leave a direction open.
bool solve(out float x[6]) {
  float L[6][6];
  bool solvable = true;
  [[unroll]] for (uint j = 0; j < 6; ++j) {
    const float diagonal = values[triangle_at(j, j)];
    float pivot = diagonal * (1 + DAMPING);
    [[unroll]] for (uint n = 0; n < 6; ++n) pivot -= n < j ? L[j][n] * L[j][n] : 0.0;
    solvable = solvable && pivot > 1e-7 * diagonal;
    L[j][j] = sqrt(max(pivot, 1e-30));
    [[unroll]] for (uint i = 0; i < 6; ++i) {
      if (i <= j) continue;  // decided when the loops are unrolled, as below
      float sum = values[triangle_at(j, i)];
      [[unroll]] for (uint n = 0; n < 6; ++n) sum -= n < j ? L[i][n] * L[j][n] : 0.0;
      L[i][j] = sum / L[j][j];
    }
  }
  [[unroll]] for (uint i = 0; i < 6; ++i) {
    float sum = -values[ALIGN_SLOPE + i];
    [[unroll]] for (uint n = 0; n < 6; ++n) sum -= n < i ? L[i][n] * x[n] : 0.0;
    x[i] = sum / L[i][i];
  }
  [[unroll]] for (uint back = 0; back < 6; ++back) {
    const uint i = 5 - back;
    float sum = x[i];
    [[unroll]] for (uint n = 0; n < 6; ++n) sum -= n > i ? L[n][i] * x[n] : 0.0;
    x[i] = sum / L[i][i];
  }
  float probe = 0;
  [[unroll]] for (uint i = 0; i < 6; ++i) probe += x[i] * x[i];
  return solvable && !isnan(probe) && !isinf(probe);
}

/// The squared scale of a t-distribution from the weighted squares of its residuals.
float variance_of(float squares, float pixels, float least, float before) {
  return pixels > 0 ? max(squares / pixels, least) : before;
}

AlignScales scales_of_source(AlignScales before) {
  return AlignScales(variance_of(values[ALIGN_SQUARES], values[ALIGN_PIXELS], LEAST_COLOUR, before.colour),
                     variance_of(values[ALIGN_SQUARES + 1], values[ALIGN_PIXELS + 1], LEAST_DEPTH, before.depth));
}

// One workgroup: adds up the partial sums in a fixed order; then one invocation solves and moves the camera.
void main() {
  const uint i = gl_LocalInvocationID.x;
  const bool acts = i == 0 && status[0].overflow == 0;
  float sum = 0;
  for (uint source = 0; source < params.sources; ++source) {
    const float more = total(source, params.count);
    sum += more;
    values[i] = more;
    barrier();
    if (acts) {
      const uint of = params.first_source + source;
      state[0].scales[of] = scales_of_source(state[0].scales[of]);
    }
    barrier();
  }
  values[i] = sum;
  barrier();
  if (!acts) return;
  float x[6];
  if (!solve(x)) return;
  CameraState motion = state[0].base;
  motion.rotation0 = state[0].rotation0;
  motion.rotation1 = state[0].rotation1;
  motion.rotation2 = state[0].rotation2;
  const vec3 phi = vec3(x[3], x[4], x[5]);
  motion.translation = exp_so3(phi) * state[0].translation;
  move_camera(motion, phi, vec3(x[0], x[1], x[2]));
  state[0].rotation0 = motion.rotation0;
  state[0].rotation1 = motion.rotation1;
  state[0].rotation2 = motion.rotation2;
  state[0].translation = motion.translation;

  CameraState c = state[0].base;
  const mat3 R = transpose(mat3(motion.rotation0, motion.rotation1, motion.rotation2));
  const mat3 rows = mat3(c.rotation0, c.rotation1, c.rotation2);   // its columns are the base's rows
  c.rotation0 = rows * motion.rotation0;
  c.rotation1 = rows * motion.rotation1;
  c.rotation2 = rows * motion.rotation2;
  c.translation = R * c.translation + motion.translation;
  camera[0] = c;
}
