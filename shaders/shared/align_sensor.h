// Intensity and depth of the sensor's frame.
#include "align_types.h"

#define PASS align_sensor
#define PASS_PARAMS(P) P(uint, pixels)
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, uint, sensor_colour)             \
  READ(1, float, sensor_depth)             \
  WRITE(2, vec2, image)
#include "declare_pass.h"
