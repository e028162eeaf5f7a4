#version 460
#extension GL_GOOGLE_include_directive : require
#include "colour_splats.h"
#include "quaternion.glsl"
#include "projection.glsl"

/// The shortest axis as a unit normal that faces the camera, in [0, 1]: x right, y up, z towards the viewer.
vec3 encoded_normal(uint i, vec3 x_c) {
  const vec3 s = log_scales[i];
  const mat3 axes = camera_rotation(camera[0]) * rotation_of(normalize(rotations[i]));
  vec3 normal = s.x <= s.y && s.x <= s.z ? axes[0] : s.y <= s.z ? axes[1] : axes[2];
  if (dot(normal, x_c) > 0) normal = -normal;
  return 0.5 + 0.5 * vec3(normal.x, -normal.y, -normal.z);
}

// One invocation per visible Gaussian.
void main() {
  const uint v = gl_GlobalInvocationID.x;
  if (v >= visible_count[0]) return;
  const uint i = visible_ids[v];
  const CameraState c = camera[0];
  const vec3 x_c = to_camera(c, means[i]);
  if (PREPARE == PREPARE_UNCERTAINTY) splats[i].colour = vec3(uncertainty[i]);
  if (PREPARE == PREPARE_NORMAL) splats[i].colour = encoded_normal(i, x_c);
  if (PREPARE == PREPARE_SOLID) {
    vec3 row0, row1;
    const mat3 V = camera_axes(c, rotations[i], log_scales[i]);
    image_axes(perspective_of(c, x_c), V, row0, row1);
    const vec3 row2 = transpose(V)[2];
    const vec2 slope = depth_slope_of(row0, row1, row2, splats[i].conic);
    splats[i].slope = slope;  // also where rendering takes the depth of the centre
    reliefs[i] = sqrt(max(dot(row2, row2) - dot(slope, vec2(dot(row0, row2), dot(row1, row2))), 0));
  }
}
