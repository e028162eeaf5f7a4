// Puts something else that a Gaussian has into the place of its colour, so that blending shows that.
#include "view_types.h"

#define PASS colour_splats
#define PASS_CONSTANTS(C) C(1, PREPARE, 0)
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, CameraState, camera)             \
  READ(1, vec3, means)                     \
  READ(2, vec3, log_scales)                \
  READ(3, vec4, rotations)                 \
  READ(4, float, uncertainty)              \
  READ(5, uint, visible_count)             \
  READ(6, uint, visible_ids)               \
  UPDATE(7, Splat, splats)                 \
  WRITE(8, float, reliefs) /* standard deviation of z over a pixel's ray, metres */
#include "declare_pass.h"
