#version 460
#extension GL_GOOGLE_include_directive : require
#include "blend_forward.h"
#include "quaternion.glsl"
#include "projection.glsl"
#include "tile_pixels.glsl"

// One subgroup (= one workgroup) per tile; lib/tile_pixels.glsl says which lane owns which pixels. The tile's Gaussians
// are visited near to far until no pixel lets light through. A pixel that has stopped keeps a transmittance of 0, and
// masks are arithmetic: a branch would not save work on every device.
void main() {
  const CameraState c = camera[0];
  const uint tile = gl_WorkGroupID.y * ((c.width + TILE_W - 1) / TILE_W) + gl_WorkGroupID.x;
  const uvec2 range = tile_ranges[tile];

  float transmittance[PIXELS], opacity[PIXELS], depth[PIXELS], sensor[PIXELS];
  vec3 colour[PIXELS];
  float median[PIXELS], uncertainty[PIXELS], best[PIXELS];
  uint dominator[PIXELS];
  [[unroll]] for (uint k = 0; k < PIXELS; ++k) {
    const uvec2 pixel = lane_pixel(k % COLUMNS, k / COLUMNS);
    const bool inside = pixel.x < c.width && pixel.y < c.height;
    transmittance[k] = inside ? 1.0 : 0.0;
    opacity[k] = depth[k] = median[k] = uncertainty[k] = best[k] = sensor[k] = 0;
    if (WITH_GEOMETRY == 1 && inside) sensor[k] = sensor_depth[pixel.y * c.width + pixel.x];
    colour[k] = vec3(0);
    dominator[k] = 0xFFFFFFFFu;
  }

  const vec2 origin = vec2(lane_origin());
  for (uint batch = range.x; batch < range.y; batch += LANES) {
    const uint mine = batch + batch_order(gl_SubgroupInvocationID);
    uint my_id = 0;
    Splat my = Splat(vec2(0), vec3(0), 0.0, vec3(0), 0.0);
    if (mine < range.y) {
      my_id = instance_owners[instances[mine]];
      my = splats[my_id];
    }
    for (uint group = 0; group < GROUPS; ++group) {
      [[unroll]] for (uint member = 0; member < GROUP; ++member) {
        const uint lane = lane_of(group, member);
        const vec2 d = origin - subgroupShuffle(my.centre, lane);
        const vec3 conic = subgroupShuffle(my.conic, lane);
        const float splat_opacity = subgroupShuffle(my.opacity, lane);
        const vec3 splat_colour = subgroupShuffle(my.colour, lane);
        const float splat_depth = subgroupShuffle(my.depth, lane);
        const uint id = subgroupShuffle(my_id, lane);
        [[unroll]] for (uint column = 0; column < COLUMNS; ++column) {
          const float dx = d.x + float(column * LANES);
          const float xx = -0.5 * conic.x * dx * dx, xy = -conic.y * dx;
          [[unroll]] for (uint row = 0; row < ROWS; ++row) {
            const uint k = row * COLUMNS + column;
            const float dy = d.y + float(row * ROW_STEP);
            const float exponent = xx + dy * (xy - 0.5 * conic.z * dy);
            float alpha = min(ALPHA_MAX, splat_opacity * exp(exponent));
            alpha = alpha < ALPHA_MIN ? 0.0 : alpha;
            const float before = transmittance[k];
            const float after = before - alpha * before;
            const bool stops = after < TRANSMITTANCE_MIN;
            const float weight = stops ? 0.0 : alpha * before;
            transmittance[k] = stops ? 0.0 : after;
            colour[k] += weight * splat_colour;
            depth[k] += weight * splat_depth;
            opacity[k] += weight;
            if (WITH_GEOMETRY == 1) {
              median[k] = before >= 0.5 && after < 0.5 ? splat_depth : median[k];
              const float off = splat_depth - sensor[k];
              uncertainty[k] += weight * off * off;
              dominator[k] = weight > best[k] ? id : dominator[k];
              best[k] = max(best[k], weight);
            }
          }
        }
      }
    }
    float open = 0;
    [[unroll]] for (uint k = 0; k < PIXELS; ++k) open = max(open, transmittance[k]);
    if (!subgroupAny(open > 0)) break;
  }

  [[unroll]] for (uint k = 0; k < PIXELS; ++k) {
    const uvec2 pixel = lane_pixel(k % COLUMNS, k / COLUMNS);
    if (pixel.x >= c.width || pixel.y >= c.height) continue;
    const uint at = pixel.y * c.width + pixel.x;
    colour_opacity[at] = vec4(colour[k] + (1 - opacity[k]) * params.background, opacity[k]);
    geometry[at] = vec4(depth[k], median[k], sensor[k] > 0 ? uncertainty[k] : 0.0, best[k]);
    if (WITH_GEOMETRY == 1) dominators[at] = dominator[k];
  }
}
