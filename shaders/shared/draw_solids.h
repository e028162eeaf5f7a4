// Draws Gaussians as solid ellipsoids, or their centres as dots; the nearest hides the others.
#include "view_types.h"

#define PASS draw_solids
#define PASS_CONSTANTS(C)                        \
  C(1, TILE_W, 8) C(2, TILE_H, 8) C(3, LANES, 8) \
  C(4, DOTS, 0)
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, CameraState, camera)             \
  READ(1, Splat, splats)                   \
  READ(2, float, reliefs)                  \
  READ(3, uint, tile_gaussians)            \
  READ(4, uvec2, tile_ranges)              \
  WRITE(5, vec4, colour_opacity)           \
  WRITE(6, vec4, geometry) /* as blend_forward leaves it: depth and median depth */
#include "declare_pass.h"
