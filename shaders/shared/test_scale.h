// For the tests of gpu/: values[i] = factor * values[i] + offsets[i].
#include "language.h"

#define PASS test_scale
#define PASS_CONSTANTS(C) C(1, REPEATS, 1)
#define PASS_PARAMS(P) P(uint, count) P(float, factor)
#define PASS_BINDINGS(READ, WRITE, UPDATE) READ(0, float, offsets) UPDATE(1, float, values)
#include "declare_pass.h"
