// Brings a sensor frame to the pixels of a view from the same pose with other intrinsics.
#include "view_types.h"

#define PASS resample_sensor
#define PASS_PARAMS(P)                                                                       \
  P(uvec2, size) P(uvec2, sensor_size)                                                       \
  P(vec2, scale) P(vec2, offset) /* a pixel of the sensor is scale * that of the view + offset */
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, uint, sensor_colour)             \
  READ(1, float, sensor_depth)             \
  WRITE(2, uint, colour) /* 0 where the sensor does not see */ \
  WRITE(3, float, depth)
#include "declare_pass.h"
