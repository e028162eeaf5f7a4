// Adds up the partial sums of the mapping loss.
#include "loss_types.h"

#define PASS sum_losses
#define PASS_PARAMS(P) P(uint, count)
#define PASS_BINDINGS(READ, WRITE, UPDATE) READ(0, LossSums, loss_partials) WRITE(1, LossSums, loss)
#include "declare_pass.h"
