// How a subgroup works a tile. Needs splat_types.h, projection.glsl and the constants TILE_W, TILE_H and LANES (= the
// subgroup and workgroup size).
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
/// shuffles, GROUP at a time: GROUP bodies are unrolled, few enough to stay in a CPU's instruction cache.
const uint GROUP = 2;

/// A Gaussian as a lane loads it for all pixels of the tile: what does not need the pixel is done once.
struct Stamp {
  vec2 centre;
  vec3 form;            // log2 of exp(-d^T conic d / 2), by dx dx, dx dy and dy dy
  float log_opacity;    // log2
  vec3 colour;
  float depth;
  vec2 slope;
};

const Stamp NO_STAMP = Stamp(vec2(0), vec3(0), -1000.0, vec3(0), 0.0, vec2(0));

Stamp stamp_of(Splat s) {
  const float LOG2_E = 1.4426950408889634;
  return Stamp(s.centre, -LOG2_E * vec3(0.5 * s.conic.x, s.conic.y, 0.5 * s.conic.z), log2(s.opacity), s.colour,
               s.depth, s.slope);
}

/// The stamp that `lane` has loaded.
Stamp stamp_from(Stamp my, uint lane) {
  return Stamp(subgroupShuffle(my.centre, lane), subgroupShuffle(my.form, lane),
               subgroupShuffle(my.log_opacity, lane), subgroupShuffle(my.colour, lane),
               subgroupShuffle(my.depth, lane), subgroupShuffle(my.slope, lane));
}

/// One Gaussian in front of one pixel. A pixel that has stopped keeps a transmittance of 0; masks are arithmetic, since
/// a branch would not save work on every device.
struct Layer {
  float raw;      // opacity times the Gaussian, before the clamp
  float left;     // transmittance behind, if the pixel does not stop here
  float weight;   // alpha times the transmittance in front; 0 from the stop on
  bool stops;
};

Layer layer_of(float log_alpha, float transmittance) {
  Layer l;
  l.raw = exp2(log_alpha);
  const float alpha = l.raw < ALPHA_MIN ? 0.0 : min(ALPHA_MAX, l.raw);
  const float weight = alpha * transmittance;
  l.left = transmittance - weight;
  l.stops = l.left < TRANSMITTANCE_MIN;
  l.weight = l.stops ? 0.0 : weight;
  return l;
}

// Butterflies count bits: compilers unroll loops that add a constant, not all of those that double a step.

/// Sums a value of each of the two members of a group over the subgroup: even lanes get the total of the first, odd ones
/// that of the second.
float reduce_group(float a[GROUP]) {
  const bool odd = (gl_SubgroupInvocationID & 1) != 0;
  float total = (odd ? a[1] : a[0]) + subgroupShuffleXor(odd ? a[0] : a[1], 1);
  [[unroll]] for (uint bit = 1; bit < 6; ++bit)
    if ((1u << bit) < LANES) total += subgroupShuffleXor(total, 1u << bit);
  return total;
}
