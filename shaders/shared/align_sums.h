// Partial sums of a Gauss-Newton step of the alignment.
#include "align_types.h"

#define PASS align_sums
#define PASS_PARAMS(P)                                          \
  P(uint, width) P(uint, height) P(uint, level) P(uint, strips) \
  P(uint, stride)  /* of the pixels that take part */              \
  P(float, balance) /* weight of the geometric term */
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, AlignState, state)               \
  READ(1, AlignPoint, points)              \
  READ(2, vec2, sensor)                    \
  WRITE(3, AlignSums, partial_sums)
#include "declare_pass.h"
