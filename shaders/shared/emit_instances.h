// Writes one instance per (visible Gaussian, tile that it touches), near to far.
#include "splat_types.h"

#define PASS emit_instances
#define PASS_CONSTANTS(C) C(1, TILE_W, 8) C(2, TILE_H, 8)
#define PASS_PARAMS(P) P(uint, capacity)
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, CameraState, camera)             \
  READ(1, Splat, splats)                   \
  READ(2, uint, visible_count)             \
  READ(3, uint, depth_order)               \
  READ(4, uint, sorted_offsets)            \
  READ(5, uint, instance_total)            \
  WRITE(6, uint, tile_keys)                \
  WRITE(7, uint, instances)                \
  WRITE(8, uint, instance_owners)          \
  UPDATE(9, RenderStatus, status)          \
  WRITE(10, uint, instance_count)          \
  READ(11, uint, sorted_counts)            \
  READ(12, uint, instance_offsets)
#include "declare_pass.h"
