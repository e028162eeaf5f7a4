// Last of three passes that sort by one digit: moves every pair to its place.
#include "language.h"
#include "sort_shape.h"

#define PASS sort_scatter
#define PASS_CONSTANTS(C) C(1, CHUNK_LEAST, 1)
#define PASS_PARAMS(P) P(uint, capacity) P(uint, columns) P(uint, shift) P(uint, digit_bits)
#define PASS_BINDINGS(READ, WRITE, UPDATE)                                                                       \
  READ(0, uint, count) READ(1, uint, keys) READ(2, uint, values) READ(3, uint, table) READ(4, uint, digit_totals) \
  WRITE(5, uint, sorted_keys) WRITE(6, uint, sorted_values)
#include "declare_pass.h"
