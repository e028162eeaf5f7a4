// Gradient of the tracking loss (paper eq. 19) with respect to the rendered images.
#include "loss_types.h"

#define PASS track_gradient
#define PASS_CONSTANTS(C) C(1, NORMALISED_DEPTH, 1)
#define PASS_PARAMS(P) P(uint, pixels) P(float, weight_colour) P(float, weight_depth) P(vec3, background)
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, vec4, colour_opacity)            \
  READ(1, vec4, geometry)                  \
  READ(2, uint, sensor_colour)             \
  READ(3, float, sensor_depth)             \
  READ(4, vec2, residuals)                 \
  READ(5, vec2, limits)                    \
  READ(6, TrackSums, sums)                 \
  WRITE(7, PixelUpstream, pixel_upstream)
#include "declare_pass.h"
