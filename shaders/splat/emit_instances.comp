#version 460
#extension GL_GOOGLE_include_directive : require
#include "emit_instances.h"
#include "quaternion.glsl"
#include "projection.glsl"
#include "tiles.glsl"

// One invocation per visible Gaussian, in depth order: writes its instances one after the other, so that a stable sort
// by tile alone leaves each tile's list near to far. The name of an instance is the place that the backward pass stores
// its sums in: those of one Gaussian lie side by side, and Gaussians follow each other as in the map, since passes that go
// through memory in order are several times faster on a CPU. When there is not room for all of them, none is written and
// the overflow is flagged.
void main() {
  const uint v = gl_GlobalInvocationID.x;
  const uint total = instance_total[0];
  const bool fits = total <= params.capacity;
  if (v == 0) {
    status[0].visible = visible_count[0];
    status[0].instances = total;
    if (!fits) {
      status[0].overflow = 1;
      status[0].needed = max(status[0].needed, total);
    }
    if (status[0].overflow == 0) status[0].completed += 1;
    instance_count[0] = fits ? total : 0;
  }
  if (v >= visible_count[0] || !fits) return;

  const CameraState c = camera[0];
  const uint id = depth_order[v];
  const Footprint f = footprint_of(c, splats[id]);
  const uint columns = tiles_of(c).x;
  uint place = sorted_offsets[v], name = instance_offsets[id];
  // project_splats counted the same tiles; should a compiler make the two differ, no neighbour's place may suffer.
  const uint end = place + sorted_counts[v];
  for (uint row = f.rows.x; row < f.rows.y; ++row) {
    const uvec2 touched = touched_tiles(f, c, row);
    for (uint column = touched.x; column < touched.y && place < end; ++column) {
      tile_keys[place] = row * columns + column;
      instances[place] = name;
      instance_owners[name] = id;
      ++place;
      ++name;
    }
  }
  for (; place < end; ++place, ++name) {
    tile_keys[place] = 0;
    instances[place] = name;
    instance_owners[name] = id;
  }
}
