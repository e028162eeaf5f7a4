// Casts rays from a camera into a synthetic scene: exact depth at the pixel centres, each row at its own time, shaded colour
// from several samples a pixel, each at its own time of the exposure.
#include "synth_types.h"

#define PASS cast_scene
#define PASS_PARAMS(P)                                                                                            \
  P(uint, width) P(uint, height) P(float, fx) P(float, fy) P(float, cx) P(float, cy)                              \
  P(uint, shapes)                                                                                                 \
  P(uint, first_round)    /* shapes before this one are boxes */                                                  \
  P(uint, first_moving)   /* shapes from here on move: they are not in the lists of the lights */                 \
  P(uint, lights)                                                                                                 \
  P(uint, samples)        /* of colour a pixel, a multiple of 4 */                                                \
  P(uint, depth_poses)    /* evenly spaced in time, from the first row to the last */                             \
  P(uint, colour_poses)   /* evenly spaced in time */                                                             \
  P(float, readout)       /* time from the first row to the last, of the time that colour_poses span */           \
  P(float, exposure)      /* time that a row is exposed, likewise */                                              \
  P(float, wander)        /* no pose is further from the first one than this, m */                                \
  P(float, swing)         /* nor turned further than this, radians */                                             \
  P(float, brightness)                                                                                            \
  P(uint, seed)
#define PASS_BINDINGS(READ, WRITE, UPDATE)                                                  \
  READ(0, CastPose, poses)            /* of depth, then those of colour */                  \
  READ(1, SceneShape, shapes)                                                               \
  READ(2, SceneSurface, surfaces)                                                           \
  READ(3, SceneMaterial, materials)                                                         \
  READ(4, SceneLight, lights)                                                               \
  READ(5, uvec2, light_cells)         /* first of light_entries and how many */        \
  READ(6, LightEntry, light_entries)  /* of a cell, near to far */                          \
  WRITE(7, uint, colour)              /* R, G, B, 255 from the lowest byte up */            \
  WRITE(8, float, depth)              /* camera z, 0 where nothing is hit */                \
  WRITE(9, uint, hit_shapes)          /* at the pixel centre; NO_SHAPE where nothing is hit */
#include "declare_pass.h"
