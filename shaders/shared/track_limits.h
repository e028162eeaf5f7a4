// From the histograms of residuals to the largest residuals that take part.
#include "loss_types.h"

#define PASS track_limits
#define PASS_PARAMS(P) P(float, outlier_factor)
#define PASS_BINDINGS(READ, WRITE, UPDATE) READ(0, uint, histograms) WRITE(1, vec2, limits)
#include "declare_pass.h"
