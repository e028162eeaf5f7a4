// Residuals of the tracking loss and their histogram.
#include "loss_types.h"

#define PASS track_residuals
#define PASS_CONSTANTS(C) C(1, NORMALISED_DEPTH, 1)
#define PASS_PARAMS(P) P(uint, pixels) P(float, minimum_opacity) P(vec3, noise) /* lib/depth_noise.glsl */
#define PASS_BINDINGS(READ, WRITE, UPDATE)                                           \
  READ(0, vec4, colour_opacity)                                                      \
  READ(1, vec4, geometry)                                                            \
  READ(2, uint, sensor_colour)                                                       \
  READ(3, float, sensor_depth)                                                       \
  WRITE(4, vec2, residuals)   /* of colour and depth; negative: not part of it */    \
  UPDATE(5, uint, histograms) /* RESIDUAL_BINS of colour, then of depth, then two counts */
#include "declare_pass.h"
