// Prefix sums over the invocations of a workgroup of any size, through shared memory and without subgroup operations.
// The includer names in WORKGROUP_SCAN_SCRATCH a shared uint array of at least gl_WorkGroupSize.x entries, which is
// overwritten and free again when a function returns. Every invocation of the workgroup must call it.
#ifndef SUREFIELD_LIB_WORKGROUP_SCAN_GLSL
#define SUREFIELD_LIB_WORKGROUP_SCAN_GLSL

// The workgroup falls into teams of `width` consecutive invocations, a power of two that divides its size. Returns the
// sum of `value` over the invocations of the team before this one; `total` becomes the sum over the whole team.
uint team_exclusive_scan(uint value, uint width, out uint total) {
  const uint i = gl_LocalInvocationID.x;
  const uint member = i % width;
  uint inclusive = value;
  for (uint distance = 1; distance < width; distance *= 2) {
    WORKGROUP_SCAN_SCRATCH[i] = inclusive;
    barrier();
    if (member >= distance) inclusive += WORKGROUP_SCAN_SCRATCH[i - distance];
    barrier();
  }
  WORKGROUP_SCAN_SCRATCH[i] = inclusive;
  barrier();
  total = WORKGROUP_SCAN_SCRATCH[i - member + width - 1];
  barrier();
  return inclusive - value;
}

// The same with the whole workgroup, of any size, as one team.
uint workgroup_exclusive_scan(uint value, out uint total) {
  return team_exclusive_scan(value, gl_WorkGroupSize.x, total);
}

#endif
