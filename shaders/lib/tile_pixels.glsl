// How a subgroup works a tile. Needs the constants TILE_W, TILE_H and LANES (= the subgroup and workgroup size).
//
// A tile has TILE_W x TILE_H pixels and one subgroup; each lane owns PIXELS of them, COLUMNS wide and ROWS high:
// pixel (column, row) of a lane lies at lane_origin() + (column * LANES, row * ROW_STEP). So all pixels of a lane's
// column share their x, and sums over y factor out of the inner loop.

const uint COLUMNS = TILE_W > LANES ? TILE_W / LANES : 1;
const uint ROW_STEP = TILE_W > LANES ? 1 : LANES / TILE_W;
const uint ROWS = TILE_H / ROW_STEP;
const uint PIXELS = COLUMNS * ROWS;

uvec2 lane_origin() {
  return uvec2(gl_WorkGroupID.x * TILE_W + gl_SubgroupInvocationID % TILE_W,
               gl_WorkGroupID.y * TILE_H + gl_SubgroupInvocationID / TILE_W);
}

uvec2 lane_pixel(uint column, uint row) {
  return lane_origin() + uvec2(column * LANES, row * ROW_STEP);
}

/// The Gaussians of a tile are taken in batches of LANES, a lane loading one each; they are then handed round by
/// shuffles, GROUP at a time. Lane l loads number batch_order(l) of the batch, so that the sums of a group, reduced
/// over the subgroup by reduce_group(), end up in the very lanes that loaded those Gaussians.
const uint GROUP = 4;
const uint GROUPS = LANES / GROUP;

uint batch_order(uint lane) {
  return (lane % GROUPS) * GROUP + lane / GROUPS;
}

/// The lane that loaded Gaussian `member` of group `group`.
uint lane_of(uint group, uint member) {
  return member * GROUPS + group;
}

/// Sums a value of each of the four members of a group over the subgroup: lane l gets the total of member l / GROUPS.
/// A transposed butterfly: the first two steps halve the number of members that a lane works for.
float reduce_group(float a[GROUP]) {
  const uint lane = gl_SubgroupInvocationID;
  const bool high = (lane & (LANES / 2)) != 0;
  const float first = (high ? a[2] : a[0]) + subgroupShuffleXor(high ? a[0] : a[2], LANES / 2);
  const float second = (high ? a[3] : a[1]) + subgroupShuffleXor(high ? a[1] : a[3], LANES / 2);
  const bool odd = (lane & (LANES / 4)) != 0;
  float total = (odd ? second : first) + subgroupShuffleXor(odd ? first : second, LANES / 4);
  [[unroll]] for (uint step = GROUPS / 2; step > 0; step /= 2) total += subgroupShuffleXor(total, step);
  return total;
}
