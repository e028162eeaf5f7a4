// Prefix sums over the invocations of a workgroup of any size, through shared memory and without subgroup operations.
// The includer names in WORKGROUP_SCAN_SCRATCH a shared uint array of at least gl_WorkGroupSize.x entries, which is
// overwritten and free again when the function returns.
#ifndef SUREFIELD_LIB_WORKGROUP_SCAN_GLSL
#define SUREFIELD_LIB_WORKGROUP_SCAN_GLSL

// Returns the sum of `value` over all invocations before this one; `total` becomes the sum over all. Every invocation
// of the workgroup must call it.
uint workgroup_exclusive_scan(uint value, out uint total) {
  const uint i = gl_LocalInvocationID.x;
  uint inclusive = value;
  for (uint distance = 1; distance < gl_WorkGroupSize.x; distance *= 2) {
    WORKGROUP_SCAN_SCRATCH[i] = inclusive;
    barrier();
    if (i >= distance) inclusive += WORKGROUP_SCAN_SCRATCH[i - distance];
    barrier();
  }
  WORKGROUP_SCAN_SCRATCH[i] = inclusive;
  barrier();
  total = WORKGROUP_SCAN_SCRATCH[gl_WorkGroupSize.x - 1];
  barrier();
  return inclusive - value;
}

#endif
