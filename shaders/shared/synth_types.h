// Records of the synthetic scenes. Metres; colours are linear RGB; z is up in the world.
#ifndef SUREFIELD_SHARED_SYNTH_TYPES_H
#define SUREFIELD_SHARED_SYNTH_TYPES_H

#include "language.h"

SHARED_TYPES_BEGIN

SHARED_CONST uint SHAPE_BOX = 0;
SHARED_CONST uint SHAPE_ELLIPSOID = 1;
SHARED_CONST uint SHAPE_CYLINDER = 2;  // along the third axis, closed at both ends

SHARED_CONST uint NO_SHAPE = 0xFFFFFFFFu;
SHARED_CONST uint SCENE_SHAPES = 4096;  // the most shapes of a scene

SHARED_CONST uint CAST_TILE = 8;        // pixels along a side of the tile that one workgroup works
SHARED_CONST uint LIGHT_CELLS = 64;     // cells along an edge of the cube around a light

// What the base colour of a material is modulated by.
SHARED_CONST uint PATTERN_PLAIN = 0;   // noise and cells
SHARED_CONST uint PATTERN_POSTER = 1;  // a picture of discs and bars over lines of text
SHARED_CONST uint PATTERN_VIEW = 2;    // sky over hills, seen through a window
SHARED_CONST uint PATTERN_SCREEN = 3;  // lines of text, as on a monitor

/// A convex body. In unit coordinates M (x - centre) a box fills |x|, |y|, |z| <= 1, an ellipsoid the unit ball, a
/// cylinder x^2 + y^2 <= 1, |z| <= 1.
struct SceneShape {
  vec3 centre;
  vec3 row0;  // M by rows
  vec3 row1;
  vec3 row2;
  uint kind;
};

/// What a shape is made of.
struct SceneSurface {
  vec3 half_size;       // metres for one unit coordinate
  vec3 texture_origin;  // world position where the texture's coordinates are 0
  uint material;
  uint seed;            // so that two bodies of one material differ
};

struct SceneMaterial {
  vec3 first;
  vec3 second;
  vec3 noise_frequency;  // of the coarsest octave along the axes of the shape, 1/m
  float noise_contrast;  // 1: noise goes all the way from the first colour to the second
  float noise_decay;     // weight of an octave relative to the one before it
  vec2 cell;             // size of a tile, plank, brick or book, m
  float cell_shift;      // of each row relative to the one below, in cells
  float cell_contrast;   // 1: cells go at random all the way from the first colour to the second
  float cell_hue;        // 1: each cell has a colour of its own
  float joint;           // width of the dark line between cells, m
  float gloss;
  float shininess;
  float emission;        // part of the colour that shines by itself
  uint pattern;
  uint seed;
};

struct SceneLight {
  vec3 position;
  vec3 colour;
  float range;  // nothing is lit beyond, m
};

/// A body that can stand between a light and what lies behind a cell of the cube around it.
struct LightEntry {
  uint shape;
  float nearest;  // the light is no closer to it, m
};

/// Camera axes and centre in the world.
struct CastPose {
  vec3 origin;
  vec3 right;
  vec3 down;
  vec3 forward;
};

SHARED_TYPES_END

#endif
