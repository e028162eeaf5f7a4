// Intensity and depth of what was rendered, where the map covers the pixel.
#include "align_types.h"

#define PASS align_rendered
#define PASS_CONSTANTS(C) C(1, NORMALISED_DEPTH, 1)
#define PASS_PARAMS(P) P(uint, pixels) P(float, minimum_opacity)
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, vec4, colour_opacity)            \
  READ(1, vec4, geometry)                  \
  WRITE(2, vec2, image) /* depth 0 where not covered */
#include "declare_pass.h"
