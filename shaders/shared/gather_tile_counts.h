// Puts the tile counts of the visible Gaussians into depth order.
#include "splat_types.h"

#define PASS gather_tile_counts
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, uint, visible_count)             \
  READ(1, uint, depth_order)               \
  READ(2, uint, tile_counts)               \
  WRITE(3, uint, sorted_counts)
#include "declare_pass.h"
