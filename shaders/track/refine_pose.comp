#version 460
#extension GL_GOOGLE_include_directive : require
#include "refine_pose.h"
#include "adam.glsl"
#include "pose.glsl"

// A single invocation.
void main() {
  if (gl_GlobalInvocationID.x != 0 || status[0].overflow != 0) return;
  const PoseGradient g = pose_gradient[0];
  if (!is_finite(g)) return;
  CameraState c = camera[0];
  PoseAdam state = adam[0];
  adam_move(c, state, g, params.rate_rotation, params.rate_translation);
  camera[0] = c;
  adam[0] = state;
}
