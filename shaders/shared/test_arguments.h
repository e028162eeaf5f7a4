// For the tests of gpu/: args[i] = workgroups of an indirect dispatch.
#include "language.h"

#define PASS test_arguments
#define PASS_PARAMS(P) P(uint, count) P(uint, groups)
#define PASS_BINDINGS(READ, WRITE, UPDATE) WRITE(0, uvec3, args)
#include "declare_pass.h"
