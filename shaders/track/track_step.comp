#version 460
#extension GL_GOOGLE_include_directive : require
#include "track_step.h"
#include "adam.glsl"
#include "pose.glsl"
#include "tracking_loss.glsl"

// A single invocation. The loss belongs to the camera as it was rendered, so the best pose is taken before the step. A
// render that had to leave Gaussians out, or one that no pixel can be compared with, changes nothing.
void main() {
  if (gl_GlobalInvocationID.x != 0 || status[0].overflow != 0) return;
  const TrackSums s = sums[0];
  const bool comparable = is_comparable(s);
  const float loss = tracking_loss(s, params.weight_colour, params.weight_depth);
  CameraState c = camera[0];
  if (comparable && loss < state[0].best_loss) {
    state[0].best_loss = loss;
    state[0].best_camera = c;
    state[0].best_valid = s.depth_pixels / max(params.sensor_pixels, 1);
    state[0].best_explained = float(histograms[RESIDUAL_EXPLAINED]) / max(params.sensor_pixels, 1);
    state[0].best_through = float(histograms[RESIDUAL_THROUGH]) / max(params.sensor_pixels, 1);
  }
  PoseAdam adam = state[0].adam;
  const PoseGradient g = pose_gradient[0];
  if (comparable && is_finite(g)) {
    state[0].last_update = adam_move(c, adam, g, params.rate_rotation, params.rate_translation);
    camera[0] = c;
  }
  state[0].adam = adam;
}
