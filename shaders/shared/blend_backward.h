// Gradients of every Gaussian's projection, summed over each tile that it touches.
#include "splat_types.h"

#define PASS blend_backward
#define PASS_CONSTANTS(C) C(1, TILE_W, 8) C(2, TILE_H, 8) C(3, LANES, 8)
#define PASS_BINDINGS(READ, WRITE, UPDATE)   \
  READ(0, CameraState, camera)               \
  READ(1, Splat, splats)                     \
  READ(2, uint, instances)                   \
  READ(3, uint, tile_gaussians)              \
  READ(4, uvec2, tile_ranges)                \
  READ(5, float, sensor_depth)               \
  READ(6, PixelUpstream, pixel_upstream)     \
  WRITE(7, FootprintGradient, footprint_gradients) /* per instance */ \
  WRITE(8, LayerGradient, layer_gradients)
#include "declare_pass.h"
