#version 460
#extension GL_GOOGLE_include_directive : require
#include "move_gaussians.h"
#include "quaternion.glsl"

// One invocation per Gaussian of the map.
void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= params.count || anchors[i] >= params.anchors) return;
  const AnchorMotion motion = motions[anchors[i]];
  const vec3 before = means[i], after = rotation_of(motion.rotation) * before + motion.translation;
  means[i] = after;
  rotations[i] = quaternion_product(motion.rotation, rotations[i]);
  if (distance(before, after) <= MOMENTS_REACH) return;
  means_m[i] = vec3(0);
  means_v[i] = vec3(0);
  rotations_m[i] = vec4(0);
  rotations_v[i] = vec4(0);
}
