// Adds up the partial sums of an alignment. Needs align_types.h and partial_sums, as words. Each invocation takes one of
// the numbers that a sum consists of: records in shared memory would cost some compilers a minute.

const uint ROW = 32;                              // invocations side by side, one a number
const uint ROWS = gl_WorkGroupSize.x / ROW;       // that share the partial sums out; the workgroup is a multiple of ROW
shared float row_sums[gl_WorkGroupSize.x];

/// The sum of the `number`-th run of `count` partial sums, always in the same order: its i-th number for invocation
/// i < ALIGN_VALUES of the workgroup, all of which take part.
float total(uint number, uint count) {
  const uint i = gl_LocalInvocationID.x, value = i % ROW;
  float sum = 0;
  for (uint k = i / ROW; k < count; k += ROWS)
    sum += uintBitsToFloat(partial_sums[(number * count + k) * ALIGN_VALUES + min(value, ALIGN_VALUES - 1)]);
  barrier();
  row_sums[i] = sum;
  barrier();
  sum = 0;
  for (uint row = 0; row < ROWS; ++row) sum += row_sums[row * ROW + value];
  return sum;
}
