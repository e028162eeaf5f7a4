// What the passes that paint views share (engine/viewer).
#ifndef SUREFIELD_SHARED_VIEW_TYPES_H
#define SUREFIELD_SHARED_VIEW_TYPES_H

#include "splat_types.h"

SHARED_TYPES_BEGIN

// What colour_splats prepares.
SHARED_CONST uint PREPARE_UNCERTAINTY = 0;
SHARED_CONST uint PREPARE_NORMAL = 1;
SHARED_CONST uint PREPARE_SOLID = 2;

// How shade_view makes colours of what was rendered.
SHARED_CONST uint SHADE_COLOUR = 0;
SHARED_CONST uint SHADE_DEPTH = 1;
SHARED_CONST uint SHADE_MEDIAN_DEPTH = 2;
SHARED_CONST uint SHADE_OPACITY = 3;
SHARED_CONST uint SHADE_UNCERTAINTY = 4;
SHARED_CONST uint SHADE_GAUSSIAN_UNCERTAINTY = 5;
SHARED_CONST uint SHADE_SENSOR = 6;
SHARED_CONST uint SHADE_ERROR = 7;

SHARED_CONST float SOLID_RADIUS = 2.0f;    // of an ellipsoid drawn as a solid, in standard deviations
SHARED_CONST float DOT_RADIUS = 1.25f;     // of a centre drawn as a dot, pixels
SHARED_CONST float SOLID_OPACITY = 0.03f;  // fainter Gaussians are not drawn: their tiles do not hold all of a solid
SHARED_CONST float FULL_ERROR = 0.2f;      // mean difference of the channels that is painted in the palette alone

SHARED_CONST float CHECKER_CONTRAST = 0.06f; // by so much every other square behind the map is lighter

SHARED_CONST uint LINE_TILE = 8u;  // pixels

/// A line on the image.
struct LineSegment {
  vec2 from;                  // pixels
  vec2 to;
  float inverse_depth_from;   // 1 / metres, which is linear along the line on the image
  float inverse_depth_to;
  float half_width;           // pixels
  uint colour;                // R, G, B, opacity from the lowest byte up
};

/// The lines that may touch a tile.
struct LineTile {
  uint x;      // in tiles
  uint y;
  uint begin;  // in the list of lines by tile
  uint end;
};

SHARED_TYPES_END

#endif
