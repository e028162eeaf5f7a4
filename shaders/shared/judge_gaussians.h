// Turns the sums of a window into each Gaussian's uncertainty and takes the opacity from the uncertain ones.
#include "splat_types.h"

#define PASS judge_gaussians
#define PASS_PARAMS(P)                                            \
  P(uint, count) P(float, above) /* uncertain is who is above */  \
  P(float, logit)                /* the most that one may keep */
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, UncertaintySum, sums)            \
  UPDATE(1, float, uncertainty)            \
  UPDATE(2, float, opacity_logits)         \
  UPDATE(3, float, opacity_logits_m)       \
  UPDATE(4, float, opacity_logits_v)       \
  UPDATE(5, uint, uncertain)               \
/* 1: how many there are now, judged or not */
#include "declare_pass.h"
