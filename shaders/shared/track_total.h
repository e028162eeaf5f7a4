// Adds up the partial sums of the tracking loss.
#include "loss_types.h"

#define PASS track_total
#define PASS_PARAMS(P) P(uint, count)
#define PASS_BINDINGS(READ, WRITE, UPDATE) READ(0, TrackSums, partial_sums) WRITE(1, TrackSums, sums)
#include "declare_pass.h"
