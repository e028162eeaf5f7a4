// First half of a sum of floats: partial_sums[c] = sum of chunk c. Chunks depend on the number of values alone.
#include "language.h"
#include "reduce_shape.h"

#define PASS reduce_chunks
#define PASS_PARAMS(P) P(uint, capacity)
#define PASS_BINDINGS(READ, WRITE, UPDATE) READ(0, uint, count) READ(1, float, values) WRITE(2, float, partial_sums)
#include "declare_pass.h"
