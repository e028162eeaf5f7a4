// The next level of an image pyramid.
#include "align_types.h"

#define PASS align_halve
#define PASS_PARAMS(P) P(uint, width) P(uint, height) /* of the smaller image */ P(uint, source_width)
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, vec2, source)                    \
  WRITE(1, vec2, image)
#include "declare_pass.h"
