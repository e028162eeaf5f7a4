#version 460
#extension GL_GOOGLE_include_directive : require
#include "track_step.h"
#include "adam.glsl"
#include "pose.glsl"

// A single invocation. The loss belongs to the camera as it was rendered, so the best pose is taken before the step. A
// render that had to leave Gaussians out, or one that no pixel can be compared with, changes nothing.
void main() {
  if (gl_GlobalInvocationID.x != 0 || status[0].overflow != 0) return;
  const TrackSums s = sums[0];
  const bool comparable = s.colour_pixels > 0 || s.depth_pixels > 0;
  const float loss = params.weight_colour * s.colour / max(s.colour_pixels, 1) +
                     params.weight_depth * s.depth / max(s.depth_pixels, 1);
  CameraState c = camera[0];
  if (comparable && loss < state[0].best_loss) {
    state[0].best_loss = loss;
    state[0].best_camera = c;
    state[0].best_valid = s.depth_pixels / max(params.sensor_pixels, 1);
  }
  PoseAdam adam = state[0].adam;
  const PoseGradient g = pose_gradient[0];
  if (comparable && is_finite(g)) {
    state[0].last_update = adam_move(c, adam, g, params.rate_rotation, params.rate_translation);
    camera[0] = c;
  }
  state[0].adam = adam;
}
