// From the sums of the tiles to the gradient of every parameter of a visible Gaussian, and of the pose.
#include "splat_types.h"

#define PASS project_backward
#define PASS_CONSTANTS(C) C(1, SH_DEGREE, 0) C(2, FULL_POSE_GRADIENT, 1) \
  C(3, PLANE_DEPTH, 1) /* as in project_splats */
#define PASS_PARAMS(P) P(float, weight_isotropy) P(float, isotropy_epsilon)
#define PASS_BINDINGS(READ, WRITE, UPDATE)       \
  READ(0, CameraState, camera)                   \
  READ(1, vec3, means)                           \
  READ(2, vec3, log_scales)                      \
  READ(3, vec4, rotations)                       \
  READ(4, vec3, sh)                              \
  READ(5, Splat, splats)                         \
  READ(6, uint, visible_count)                   \
  READ(7, uint, visible_ids)                     \
  READ(8, uint, instance_offsets)                \
  READ(9, uint, tile_counts)                     \
  READ(10, FootprintGradient, footprint_gradients) /* per instance */ \
  READ(11, LayerGradient, layer_gradients)       \
  WRITE(12, GaussianGradient, gaussian_gradients) \
  WRITE(13, vec3, sh_gradients)                  \
  WRITE(14, PoseGradient, pose_partials)         \
  READ(15, RenderStatus, status)                 \
  UPDATE(16, vec2, densification) /* sum of the norm of the screen gradient, times seen */ \
  UPDATE(17, float, sampling)    /* finer where a pixel is that it had a part in */
#include "declare_pass.h"
