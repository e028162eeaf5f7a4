// Adds up the partial sums of an alignment. Needs align_types.h and partial_sums.

shared AlignSums tree[gl_WorkGroupSize.x];

AlignSums add(AlignSums a, AlignSums b) {
  [[unroll]] for (uint n = 0; n < 21; ++n) a.normal[n] += b.normal[n];
  [[unroll]] for (uint n = 0; n < 6; ++n) a.slope[n] += b.slope[n];
  a.squares_colour += b.squares_colour;
  a.squares_depth += b.squares_depth;
  a.pixels_colour += b.pixels_colour;
  a.pixels_depth += b.pixels_depth;
  return a;
}

/// The sum of the `number`-th run of `count` partial sums, for invocation i = 0, always in the same order; all of the
/// workgroup take part.
AlignSums total(uint i, uint number, uint count) {
  const uint first = number * count;
  AlignSums sum = partial_sums[first + min(i, count - 1)];   // beyond the count: not used below
  for (uint k = i + gl_WorkGroupSize.x; k < count; k += gl_WorkGroupSize.x) sum = add(sum, partial_sums[first + k]);
  barrier();
  tree[i] = sum;
  for (uint step = gl_WorkGroupSize.x / 2; step > 0; step /= 2) {
    barrier();
    if (i < step && i + step < count) tree[i] = add(tree[i], tree[i + step]);
  }
  return tree[0];
}
