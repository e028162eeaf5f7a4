// First of three passes that sort by one digit: table[d * columns + w] = how often digit d occurs in chunk w.
#include "language.h"
#include "sort_shape.h"

#define PASS sort_histogram
#define PASS_CONSTANTS(C) C(1, CHUNK_LEAST, 1)
#define PASS_PARAMS(P) P(uint, capacity) P(uint, columns) P(uint, shift) P(uint, digit_bits)
#define PASS_BINDINGS(READ, WRITE, UPDATE) READ(0, uint, count) READ(1, uint, keys) WRITE(2, uint, table)
#include "declare_pass.h"
