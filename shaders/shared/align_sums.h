// Partial sums of a Gauss-Newton step of the alignment.
#include "align_types.h"

#define PASS align_sums
#define PASS_CONSTANTS(C)                                                                       \
  C(1, FROM_KEYFRAME, 0) /* the points are those of a keyframe, not of the render */            \
  C(2, CROSSED, 0)       /* the normal matrix is that of evidence (lib/crossed_derivatives.glsl) */
#define PASS_PARAMS(P)                                          \
  P(uint, width) P(uint, height) P(uint, level) P(uint, strips) \
  P(uint, stride)  /* of the pixels that take part */              \
  P(float, weight)  /* of all terms */                             \
  P(float, balance) /* weight of the geometric term beside the photometric one */ \
  P(uint, source)   /* whose points */                                \
  P(uint, first)    /* place of the first partial sum */                          \
  P(vec3, noise)    /* of the depth (lib/depth_noise.glsl) */
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, AlignState, state)               \
  READ(1, AlignPoint, points)              \
  READ(2, vec2, sensor)                    \
  WRITE(3, AlignSums, partial_sums)
#include "declare_pass.h"
