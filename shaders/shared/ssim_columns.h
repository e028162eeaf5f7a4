// SSIM, second pass: moments blurred along the columns, SSIM and its slopes.
#include "loss_types.h"

#define PASS ssim_columns
#define PASS_PARAMS(P) P(uint, width) P(uint, height)
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, SsimMoments, moments)            \
  WRITE(1, SsimSlopes, slopes)             \
  WRITE(2, float, ssim_partials)           \
  READ(3, float, sensor_depth)
#include "declare_pass.h"
