#version 460
#extension GL_GOOGLE_include_directive : require
#include "blend_forward.h"
#include "quaternion.glsl"
#include "projection.glsl"
#include "tile_pixels.glsl"

// One subgroup (= one workgroup) per tile; lib/tile_pixels.glsl says which lane owns which pixels. The tile's Gaussians
// are visited near to far until no pixel lets light through.
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
    const uint mine = batch + gl_SubgroupInvocationID;
    uint my_id = 0;
    Stamp my = NO_STAMP;
    if (mine < range.y) {
      my_id = tile_gaussians[mine];
      my = stamp_of(splats[my_id]);
    }
    for (uint group = 0; group < LANES; group += GROUP) {
      [[unroll]] for (uint member = 0; member < GROUP; ++member) {
        const Stamp stamp = stamp_from(my, group + member);
        const uint id = WITH_DOMINATORS == 1 ? subgroupShuffle(my_id, group + member) : 0;
        const vec2 d = origin - stamp.centre;
        [[unroll]] for (uint column = 0; column < COLUMNS; ++column) {
          const float dx = d.x + float(column * LANES);
          const float along = stamp.form.x * dx * dx + stamp.log_opacity, across = stamp.form.y * dx;
          const float column_depth = stamp.depth + stamp.slope.x * dx;
          [[unroll]] for (uint row = 0; row < ROWS; ++row) {
            const uint k = row * COLUMNS + column;
            const float dy = d.y + float(row * ROW_STEP);
            const float before = transmittance[k];
            const Layer l = layer_of(along + dy * (across + stamp.form.z * dy), before);
            transmittance[k] = l.stops ? 0.0 : l.left;
            colour[k] += l.weight * stamp.colour;
            const float z = column_depth + stamp.slope.y * dy;
            depth[k] += l.weight * z;
            opacity[k] += l.weight;
            if (WITH_GEOMETRY == 1) {
              median[k] = before >= 0.5 && transmittance[k] < 0.5 ? z : median[k];
              const float off = z - sensor[k];
              uncertainty[k] += l.weight * off * off;
            }
            if (WITH_DOMINATORS == 1) {
              dominator[k] = l.weight > best[k] ? id : dominator[k];
              best[k] = max(best[k], l.weight);
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
    if (WITH_DOMINATORS == 1) dominators[at] = dominator[k];
  }
}
