// The gradient of the mapping loss (paper eq. 18, L_iso apart) with respect to the rendered images.
#include "loss_types.h"

#define PASS mapping_gradient
#define PASS_CONSTANTS(C) C(1, NORMALISED_DEPTH, 0) /* the depth terms use D_alpha / O */
#define PASS_PARAMS(P)                                                                               \
  P(uint, width) P(uint, height) P(float, valid_pixels) P(float, w_colour) P(float, w_ssim)          \
  P(float, w_depth) P(float, w_align) P(float, w_variance) P(vec3, background) P(vec3, gains)
#define PASS_BINDINGS(READ, WRITE, UPDATE)  \
  READ(0, vec4, colour_opacity)             \
  READ(1, vec4, geometry)                   \
  READ(2, uint, sensor_colour)              \
  READ(3, float, sensor_depth)              \
  READ(4, SsimSlopes, row_slopes)           \
  READ(5, uint, median_count)               \
  READ(6, float, ssim_partials)             \
  WRITE(7, PixelUpstream, pixel_upstream)   \
  WRITE(8, LossSums, loss_partials)
#include "declare_pass.h"
