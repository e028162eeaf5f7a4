#version 460
#extension GL_GOOGLE_include_directive : require
#include "blend_backward.h"
#include "quaternion.glsl"
#include "projection.glsl"
#include "tile_pixels.glsl"
const uint WITH_GEOMETRY = 1;
#include "backward_pixels.glsl"

// One subgroup per tile, as in blend_forward. Each lane sums the gradients of the Gaussian at hand over its own pixels;
// a transposed butterfly sums them over the tile and leaves them in the lane that loaded the Gaussian, which writes them
// to the instance's slot. No atomics: the result does not depend on the order in which tiles run.
void main() {
  const CameraState c = camera[0];
  const uint tile = gl_WorkGroupID.y * ((c.width + TILE_W - 1) / TILE_W) + gl_WorkGroupID.x;
  const uvec2 range = tile_ranges[tile];

  load_pixels(c);

  for (uint batch = range.x; batch < range.y; batch += LANES) {
    const uint mine = batch + gl_SubgroupInvocationID;
    uint slot = 0;
    Stamp my = NO_STAMP;
    if (mine < range.y) {
      slot = instances[mine];
      my = stamp_of(splats[tile_gaussians[mine]]);
    }
    const SplatGradient total = visit_batch(my);
    if (mine < range.y) {
      footprint_gradients[slot] = FootprintGradient(total.exponent, total.first, total.second);
      layer_gradients[slot] = LayerGradient(total.colour, total.depth, total.depth_first);
    }
    if (!tile_is_open()) break;
  }
}
