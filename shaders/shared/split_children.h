// Moves and shrinks the two children of every Gaussian that was split.
#include "splat_types.h"

#define PASS split_children
#define PASS_PARAMS(P) P(uint, count) P(uint, seed)
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, uint, sources)                   \
  UPDATE(1, vec3, means)                   \
  UPDATE(2, vec3, log_scales)              \
  READ(3, vec4, rotations)
#include "declare_pass.h"
