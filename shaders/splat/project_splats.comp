#version 460
#extension GL_GOOGLE_include_directive : require
#include "project_splats.h"
#include "quaternion.glsl"
#include "projection.glsl"
#include "tiles.glsl"
#include "sh.glsl"

// One invocation per Gaussian of the map, or of the lists at hand: projects it (docs/method.md, "Forward") and counts the tiles that it touches.
// A Gaussian that is culled gets opacity 0 and no tiles. Branches do not save work on every device, so everything is
// computed for a point in front of the camera and thrown away where the Gaussian is not.
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (LISTED == 1) {
    // emit_instances counts the views that get lists of their own.
    if (i == 0 && status[0].overflow == 0) status[0].completed += 1;
    if (i >= visible_count[0]) return;
    i = visible_ids[i];
  } else if (i >= params.count) {
    return;
  }
  const CameraState c = camera[0];
  const vec3 mean = means[i];
  vec3 x_c = to_camera(c, mean);
  const bool in_front = x_c.z >= NEAR_PLANE;
  if (!in_front) x_c = vec3(0, 0, 1);

  const Perspective p = perspective_of(c, x_c);
  vec3 row0, row1;
  const mat3 V = camera_axes(c, rotations[i], log_scales[i]);
  image_axes(p, V, row0, row1);

  Splat s;
  s.centre = p.focal_over_z * x_c.xy + vec2(c.cx, c.cy);
  s.conic = inverse_2d(covariance_2d(row0, row1, blur_of(c, sampling[i], x_c.z).x));
  const vec3 camera_centre = -(transpose(camera_rotation(c)) * c.translation);
  s.colour = max(sh_colour(i, normalize(mean - camera_centre)), vec3(0));
  s.depth = x_c.z;
  s.slope = depth_slope_of(row0, row1, transpose(V)[2], s.conic);
  if (PLANE_DEPTH == 0) s.slope = vec2(0);
  s.opacity = 1 / (1 + exp(-opacity_logits[i]));
  // A Gaussian that is not a number must not enter the image.
  const float probe = dot(s.centre, s.centre) + dot(s.conic, s.conic) + dot(s.colour, s.colour) + s.opacity + dot(s.slope, s.slope);
  if (!in_front || isnan(probe) || isinf(probe)) s.opacity = 0;

  if (uncertainty[i] > params.uncertainty_above) s.opacity = 0;

  if (LISTED == 1) {
    splats[i] = s;
    return;
  }
  const Footprint f = footprint_of(c, s);
  uint tiles = 0;
  for (uint row = f.rows.x; row < f.rows.y; ++row) {
    const uvec2 touched = touched_tiles(f, c, row);
    tiles += touched.y - touched.x;
  }
  if (tiles == 0) s.opacity = 0;
  splats[i] = s;
  tile_counts[i] = tiles;
  visible_flags[i] = tiles > 0 ? 1 : 0;
}
