// Finds where each tile's instances begin and end in the sorted list.
#include "splat_types.h"

#define PASS find_tile_ranges
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, uint, instance_count)            \
  READ(1, uint, tile_keys)                 \
  WRITE(2, uvec2, tile_ranges)
#include "declare_pass.h"
