#version 460
#extension GL_GOOGLE_include_directive : require
#include "align_begin.h"
#include "tracking_loss.glsl"

// A single invocation.
void main() {
  if (gl_GlobalInvocationID.x != 0 || status[0].overflow != 0) return;
  const TrackSums s = sums[0];
  const float loss = tracking_loss(s, params.weight_colour, params.weight_depth);
  if (is_comparable(s) && loss < state[0].best_loss) {
    state[0].best_loss = loss;
    state[0].best_camera = camera[0];
    state[0].best_valid = s.depth_pixels / max(params.sensor_pixels, 1);
    state[0].best_explained = float(histograms[RESIDUAL_EXPLAINED]) / max(params.sensor_pixels, 1);
    state[0].best_through = float(histograms[RESIDUAL_THROUGH]) / max(params.sensor_pixels, 1);
  }
  state[0].base = camera[0];
  state[0].rotation0 = vec3(1, 0, 0);
  state[0].rotation1 = vec3(0, 1, 0);
  state[0].rotation2 = vec3(0, 0, 1);
  state[0].translation = vec3(0);
}
