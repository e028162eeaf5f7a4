// For `surefield bench`: how fast the device computes and copies when nothing else is in the way.
#include "language.h"

SHARED_TYPES_BEGIN

// What MEASURE asks for.
SHARED_CONST uint PEAK_MULTIPLY_ADDS = 0;
SHARED_CONST uint PEAK_EXPONENTIALS = 1;
SHARED_CONST uint PEAK_COPY = 2;

/// Independent values of an invocation, and steps of each in one turn of its loop.
SHARED_CONST uint PEAK_CHAINS = 16;
SHARED_CONST uint PEAK_UNROLLED = 8;

SHARED_TYPES_END

#define PASS measure_peak
#define PASS_CONSTANTS(C) C(1, MEASURE, 0) C(2, ROUNDS, 512)
#define PASS_PARAMS(P) P(float, factor) P(float, offset)
#define PASS_BINDINGS(READ, WRITE, UPDATE) READ(0, vec4, source) WRITE(1, vec4, results)
#include "declare_pass.h"
