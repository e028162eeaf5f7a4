// Projects every Gaussian and counts the tiles that its footprint touches; or those alone that lie in lists already.
#include "splat_types.h"

#define PASS project_splats
#define PASS_CONSTANTS(C) C(1, TILE_W, 8) C(2, TILE_H, 8) C(3, SH_DEGREE, 0) \
  C(4, PLANE_DEPTH, 1) /* 0: the depth of the centre all over the footprint */ \
  C(5, LISTED, 0) /* 1: the visible Gaussians of the lists at hand; they are not counted again */
#define PASS_PARAMS(P) P(uint, count) P(float, uncertainty_above) /* those above are left out */
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, CameraState, camera)             \
  READ(1, vec3, means)                     \
  READ(2, vec3, log_scales)                \
  READ(3, vec4, rotations)                 \
  READ(4, float, opacity_logits)           \
  READ(5, vec3, sh)                        \
  WRITE(6, Splat, splats)                  \
  WRITE(7, uint, tile_counts)              \
  WRITE(8, uint, visible_flags)            \
  READ(9, float, uncertainty)              \
  READ(10, uint, visible_count)            \
  READ(11, uint, visible_ids)              \
  UPDATE(12, RenderStatus, status)         \
  READ(13, float, sampling)
#include "declare_pass.h"
