#version 460
#extension GL_GOOGLE_include_directive : require
#include "blend_backward_pose.h"
#include "quaternion.glsl"
#include "projection.glsl"
#include "sh.glsl"
#include "tile_pixels.glsl"
#include "backward_pixels.glsl"
#include "project_backward.glsl"

// The tracking path of blend_backward: the map is fixed and only the pose moves, so nothing is kept per Gaussian. The
// lane that loaded a Gaussian carries its sums on through the projection to the pose, LANES Gaussians at a time; at the
// end the subgroup adds up and writes one PoseGradient per tile.
void main() {
  const CameraState c = camera[0];
  const uint tile = gl_WorkGroupID.y * ((c.width + TILE_W - 1) / TILE_W) + gl_WorkGroupID.x;
  const uvec2 range = tile_ranges[tile];

  load_pixels(c);

  PoseGradient pose = PoseGradient(vec3(0), vec3(0));
  const vec3 camera_centre = -(transpose(camera_rotation(c)) * c.translation);
  for (uint batch = range.x; batch < range.y; batch += LANES) {
    const uint mine = batch + gl_SubgroupInvocationID;
    uint id = 0;
    Splat my = Splat(vec2(0), vec3(0), 0.0, vec3(0), 1.0, vec2(0));
    if (mine < range.y) {
      id = tile_gaussians[mine];
      my = splats[id];
    }
    const SplatGradient total = visit_batch(mine < range.y ? stamp_of(my) : NO_STAMP);
    if (mine < range.y) {
      const vec3 mean = means[id];
      const vec3 g_direction = direction_gradient(id, mean - camera_centre, mix(total.colour, vec3(0), equal(my.colour, vec3(0))));
      const ProjectionGradient g =
          project_backward(c, mean, sampling[id], camera_axes(c, rotations[id], log_scales[id]), my, total, g_direction);
      pose.rotation += g.pose.rotation;
      pose.translation += g.pose.translation;
    }
    if (!tile_is_open()) break;
  }

  [[unroll]] for (uint bit = 0; bit < 6; ++bit) {
    const uint step = 1u << bit;
    if (step >= LANES) continue;
    pose.rotation += subgroupShuffleXor(pose.rotation, step);
    pose.translation += subgroupShuffleXor(pose.translation, step);
  }
  if (gl_SubgroupInvocationID == 0) pose_partials[tile] = pose;
}
