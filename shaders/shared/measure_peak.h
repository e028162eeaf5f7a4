// For `surefield bench`: how fast the device computes when nothing else is in the way.
#include "language.h"

#define PASS measure_peak
#define PASS_CONSTANTS(C) C(1, EXPONENTIALS, 0) /* 0: multiply-adds */ C(2, ROUNDS, 4096)
#define PASS_PARAMS(P) P(float, factor) P(float, offset)
#define PASS_BINDINGS(READ, WRITE, UPDATE) WRITE(0, float, results)
#include "declare_pass.h"
