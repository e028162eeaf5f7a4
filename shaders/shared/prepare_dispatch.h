// Turns a count that lives on the device into the arguments of an indirect dispatch.
#include "splat_types.h"

#define PASS prepare_dispatch
#define PASS_PARAMS(P) P(uint, workgroup_size) P(uint, slot)
#define PASS_BINDINGS(READ, WRITE, UPDATE) READ(0, uint, element_count) UPDATE(1, uvec3, dispatch_args)
#include "declare_pass.h"
