// Draws lines over a picture; those behind the map are faint.
#include "view_types.h"

#define PASS draw_lines
#define PASS_PARAMS(P) P(uvec2, size) P(float, hidden) /* what is left of a line's opacity behind the map */
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, LineSegment, segments)           \
  READ(1, LineTile, line_tiles)            \
  READ(2, uint, tile_segments)             \
  READ(3, vec4, colour_opacity)            \
  READ(4, vec4, geometry)                  \
  UPDATE(5, uint, picture)
#include "declare_pass.h"
