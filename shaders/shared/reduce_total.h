// Second half of a sum of floats: result[0] = sum of the partial sums that reduce_chunks wrote. One workgroup of
// REDUCE_LANES invocations.
#include "language.h"
#include "reduce_shape.h"

#define PASS reduce_total
#define PASS_PARAMS(P) P(uint, capacity)
#define PASS_BINDINGS(READ, WRITE, UPDATE) READ(0, uint, count) READ(1, float, partial_sums) WRITE(2, float, result)
#include "declare_pass.h"
