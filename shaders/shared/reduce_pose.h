// Adds up the partial pose gradients.
#include "splat_types.h"

#define PASS reduce_pose
#define PASS_PARAMS(P)                                                                              \
  P(uint, count)              /* number of partials; 0: as many as the visible Gaussians need */    \
  P(uint, workgroup_size)     /* of project_backward */                                             \
  P(uint, subgroups)          /* partials per workgroup of project_backward */
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, uint, visible_count)             \
  READ(1, PoseGradient, pose_partials)     \
  WRITE(2, PoseGradient, pose_gradient)
#include "declare_pass.h"
