// A Gauss-Newton step of the alignment.
#include "align_types.h"

#define PASS align_step
#define PASS_PARAMS(P) P(uint, count) /* of partial sums of a source */ P(uint, first_source) P(uint, sources)
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, RenderStatus, status)            \
  READ(1, uint, partial_sums) /* AlignSums */ \
  UPDATE(2, AlignState, state)             \
  UPDATE(3, CameraState, camera)
#include "declare_pass.h"
