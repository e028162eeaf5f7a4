// Lists the visible Gaussians twice, in order of index: once to stay so, once with their depth as sort key.
#include "splat_types.h"

SHARED_TYPES_BEGIN
const uint DEPTH_KEY_BITS = 22;  // a precision of 2^-17, for depths up to 10^7 metres
SHARED_TYPES_END

#define PASS compact_visible
#define PASS_PARAMS(P) P(uint, count)
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, Splat, splats)                   \
  READ(1, uint, visible_flags)             \
  READ(2, uint, visible_offsets)           \
  WRITE(3, uint, depth_keys)               \
  WRITE(4, uint, visible_ids)              \
  WRITE(5, uint, depth_order)
#include "declare_pass.h"
