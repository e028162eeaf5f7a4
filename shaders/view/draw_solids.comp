#version 460
#extension GL_GOOGLE_include_directive : require
#include "draw_solids.h"
#include "quaternion.glsl"
#include "projection.glsl"
#include "tile_pixels.glsl"

// One subgroup (= one workgroup) per tile, as in blend_forward. In image coordinates (u, v, z), a projected Gaussian is an
// ellipsoid around (centre, depth): over pixel offset d its middle lies at depth + slope . d, and it reaches to both sides
// of that by relief * sqrt(k^2 - d^T conic d).

/// A Gaussian as a lane loads it; nothing of it is hit where opacity was too low.
struct Solid {
  vec2 centre;
  vec3 conic;    // in units of the solid's radius: d^T conic d <= 1 is hit
  vec3 colour;
  float depth;
  vec2 slope;
  float relief;  // half of its extent along z at the centre
};

const Solid NO_SOLID = Solid(vec2(-1e9), vec3(1, 0, 1), vec3(0), 0.0, vec2(0), 0.0);
const float FAR = 1e30;

Solid solid_of(Splat s, float relief) {
  if (s.opacity < SOLID_OPACITY) return NO_SOLID;
  if (DOTS == 1) return Solid(s.centre, vec3(1, 0, 1) / (DOT_RADIUS * DOT_RADIUS), s.colour, s.depth, vec2(0), 0.0);
  return Solid(s.centre, s.conic / (SOLID_RADIUS * SOLID_RADIUS), s.colour, s.depth, s.slope, relief * SOLID_RADIUS);
}

/// The solid that `lane` has loaded.
Solid solid_from(Solid my, uint lane) {
  return Solid(subgroupShuffle(my.centre, lane), subgroupShuffle(my.conic, lane), subgroupShuffle(my.colour, lane),
               subgroupShuffle(my.depth, lane), subgroupShuffle(my.slope, lane), subgroupShuffle(my.relief, lane));
}

void main() {
  const CameraState c = camera[0];
  const uvec2 range = tile_ranges[gl_WorkGroupID.y * ((c.width + TILE_W - 1) / TILE_W) + gl_WorkGroupID.x];
  float nearest[PIXELS];
  vec3 colour[PIXELS];
  [[unroll]] for (uint k = 0; k < PIXELS; ++k) {
    nearest[k] = FAR;
    colour[k] = vec3(0);
  }
  const vec2 origin = vec2(lane_origin());
  for (uint batch = range.x; batch < range.y; batch += LANES) {
    const uint mine = batch + gl_SubgroupInvocationID;
    Solid my = NO_SOLID;
    if (mine < range.y) my = solid_of(splats[tile_gaussians[mine]], reliefs[tile_gaussians[mine]]);
    for (uint member = 0; member < LANES; ++member) {
      const Solid s = solid_from(my, member);
      [[unroll]] for (uint k = 0; k < PIXELS; ++k) {
        const vec2 d = origin + vec2((k % COLUMNS) * LANES, (k / COLUMNS) * ROW_STEP) - s.centre;
        const float inside = 1 - dot(d * d, s.conic.xz) - 2 * d.x * d.y * s.conic.y;
        const float bulge = sqrt(max(inside, 0));
        const float z = s.depth + dot(s.slope, d) - s.relief * bulge;
        const bool hit = inside >= 0 && z < nearest[k] && z >= NEAR_PLANE;
        nearest[k] = hit ? z : nearest[k];
        // Lit from the camera: the rim of an ellipsoid is darker than its middle.
        colour[k] = hit ? (DOTS == 1 ? 1.0 : 0.3 + 0.7 * bulge) * s.colour : colour[k];
      }
    }
  }
  [[unroll]] for (uint k = 0; k < PIXELS; ++k) {
    const uvec2 pixel = lane_pixel(k % COLUMNS, k / COLUMNS);
    if (pixel.x >= c.width || pixel.y >= c.height) continue;
    const uint at = pixel.y * c.width + pixel.x;
    const bool seen = nearest[k] < FAR;
    colour_opacity[at] = vec4(colour[k], seen ? 1.0 : 0.0);
    geometry[at] = seen ? vec4(nearest[k], nearest[k], 0, 1) : vec4(0);
  }
}
