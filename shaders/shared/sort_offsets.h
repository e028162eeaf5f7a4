// Second of three passes that sort by one digit: every row of the table becomes its exclusive prefix sum, and
// digit_totals[d] how often digit d occurs in all.
#include "language.h"

#define PASS sort_offsets
#define PASS_CONSTANTS(C) C(1, CHUNK_LEAST, 1) C(2, TEAM, 1)
#define PASS_PARAMS(P) P(uint, capacity) P(uint, columns) P(uint, digits)
#define PASS_BINDINGS(READ, WRITE, UPDATE) READ(0, uint, count) UPDATE(1, uint, table) WRITE(2, uint, digit_totals)
#include "declare_pass.h"
