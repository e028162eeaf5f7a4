// Finds where each tile's instances begin and end in the sorted list, and whose they are.
#include "splat_types.h"

#define PASS find_tile_ranges
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, uint, instance_count)            \
  READ(1, uint, tile_keys)                 \
  READ(2, uint, instances)                 \
  READ(3, uint, instance_owners)           \
  WRITE(4, uvec2, tile_ranges)             \
  WRITE(5, uint, tile_gaussians)
#include "declare_pass.h"
