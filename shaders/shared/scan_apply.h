// Second half of an exclusive scan: from the elements and the sums of the workgroups to the prefix sums.
#include "language.h"

#define PASS scan_apply
#define PASS_PARAMS(P) P(uint, capacity)
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, uint, count) READ(1, uint, values) READ(2, uint, group_sums) WRITE(3, uint, prefix_sums) WRITE(4, uint, total)
#include "declare_pass.h"
