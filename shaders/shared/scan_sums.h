// First half of an exclusive scan: group_sums[g] = sum of the elements of workgroup g.
#include "language.h"

#define PASS scan_sums
#define PASS_PARAMS(P) P(uint, capacity)
#define PASS_BINDINGS(READ, WRITE, UPDATE) READ(0, uint, count) READ(1, uint, values) WRITE(2, uint, group_sums)
#include "declare_pass.h"
