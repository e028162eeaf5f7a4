// Blends each tile's Gaussians near to far into the rendered images.
#include "splat_types.h"

#define PASS blend_forward
#define PASS_CONSTANTS(C)                         \
  C(1, TILE_W, 8) C(2, TILE_H, 8) C(3, LANES, 8)  \
  C(4, WITH_GEOMETRY, 1) /* also median depth and uncertainty */ \
  C(5, WITH_DOMINATORS, 1) /* also the Gaussian of the largest weight */
#define PASS_PARAMS(P) P(vec3, background)
#define PASS_BINDINGS(READ, WRITE, UPDATE)                          \
  READ(0, CameraState, camera)                                      \
  READ(1, Splat, splats)                                            \
  READ(2, uint, tile_gaussians)                                     \
  READ(3, uvec2, tile_ranges)                                       \
  READ(4, float, sensor_depth)                                      \
  WRITE(5, vec4, colour_opacity)                                    \
  WRITE(6, vec4, geometry) /* D_alpha, D_median, U, weight of the dominator */ \
  WRITE(7, uint, dominators)
#include "declare_pass.h"
