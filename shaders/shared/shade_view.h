// Makes the colours of a picture of what was rendered.
#include "view_types.h"

#define PASS shade_view
#define PASS_CONSTANTS(C) C(1, SHADE, 0)
#define PASS_PARAMS(P)                                                     \
  P(uint, pixels) P(float, low) P(float, high) /* ends of the palette */   \
  P(vec3, background) P(uint, width) P(uint, checker) /* side of the squares behind the map, pixels; 0: none */
#define PASS_BINDINGS(READ, WRITE, UPDATE)                                  \
  READ(0, vec4, colour_opacity) /* on black */                              \
  READ(1, vec4, geometry)                                                   \
  READ(2, uint, sensor_colour)                                              \
  READ(3, float, sensor_depth)                                              \
  READ(4, uint, palette) /* 256 */                                          \
  WRITE(5, uint, picture) /* R, G, B, 255 from the lowest byte up */
#include "declare_pass.h"
