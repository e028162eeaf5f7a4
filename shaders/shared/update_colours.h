// One step of Adam on the spherical harmonics of every visible Gaussian; after update_gaussians, whose step count it
// shares.
#include "splat_types.h"

#define PASS update_colours
#define PASS_CONSTANTS(C) C(1, SH_DEGREE, 0)
#define PASS_PARAMS(P) P(float, rate_base) P(float, rate_rest)
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, RenderStatus, status)            \
  READ(1, uint, visible_count)             \
  READ(2, uint, visible_ids)               \
  READ(3, vec3, sh_gradients)              \
  READ(4, uint, steps)                     \
  UPDATE(5, vec3, sh)                      \
  UPDATE(6, vec3, sh_m)                    \
  UPDATE(7, vec3, sh_v)
#include "declare_pass.h"
