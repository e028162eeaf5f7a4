// Gradient of the pose alone, summed over each tile; nothing is written per Gaussian.
#include "splat_types.h"

#define PASS blend_backward_pose
#define PASS_CONSTANTS(C)                          \
  C(1, TILE_W, 8) C(2, TILE_H, 8) C(3, LANES, 8)   \
  C(4, SH_DEGREE, 0)                               \
  C(5, FULL_POSE_GRADIENT, 1) /* 0: light, through the centre and the depth alone */ \
  C(6, WITH_GEOMETRY, 1)      /* also from median depth and uncertainty */ \
  C(7, PLANE_DEPTH, 1)        /* as in project_splats */
#define PASS_BINDINGS(READ, WRITE, UPDATE)   \
  READ(0, CameraState, camera)               \
  READ(1, Splat, splats)                     \
  READ(2, uint, tile_gaussians)              \
  READ(3, uvec2, tile_ranges)                \
  READ(4, float, sensor_depth)               \
  READ(5, PixelUpstream, pixel_upstream)     \
  READ(6, vec3, means)                       \
  READ(7, vec3, log_scales)                  \
  READ(8, vec4, rotations)                   \
  READ(9, vec3, sh)                          \
  WRITE(10, PoseGradient, pose_partials)     \
  READ(11, float, sampling)
#include "declare_pass.h"
