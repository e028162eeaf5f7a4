// Masked sums of the residuals, one partial per strip of pixels.
#include "loss_types.h"

#define PASS track_sums
#define PASS_PARAMS(P) P(uint, pixels)
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, vec2, residuals)                 \
  READ(1, vec2, limits)                    \
  WRITE(2, TrackSums, partial_sums)
#include "declare_pass.h"
