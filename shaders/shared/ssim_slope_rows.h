// SSIM, third pass: its slopes blurred along the rows.
#include "loss_types.h"

#define PASS ssim_slope_rows
#define PASS_PARAMS(P) P(uint, width) P(uint, height)
#define PASS_BINDINGS(READ, WRITE, UPDATE) READ(0, SsimSlopes, slopes) WRITE(1, SsimSlopes, row_slopes)
#include "declare_pass.h"
