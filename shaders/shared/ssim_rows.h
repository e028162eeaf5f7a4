// SSIM, first pass: moments of the intensity blurred along the rows; pixels without sensor depth are as if outside of the
// image. Counts the pixels with a median depth on the way.
#include "loss_types.h"

#define PASS ssim_rows
#define PASS_PARAMS(P) P(uint, width) P(uint, height) P(vec3, gains)
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, vec4, colour_opacity)            \
  READ(1, uint, sensor_colour)             \
  READ(2, vec4, geometry)                  \
  WRITE(3, SsimMoments, moments)           \
  UPDATE(4, uint, median_count)            \
  READ(5, float, sensor_depth)
#include "declare_pass.h"
