// Records of the alignment of a frame to a render of the map and to keyframes (second-order tracking).
#ifndef SUREFIELD_SHARED_ALIGN_TYPES_H
#define SUREFIELD_SHARED_ALIGN_TYPES_H

#include "loss_types.h"

SHARED_TYPES_BEGIN

/// A pixel of the render or of a keyframe as the frame is aligned to it, in the frame of the camera that saw it.
struct AlignPoint {
  float intensity;
  float depth;      // 0: no part at all; negative: not measured, thought to be that much, and uncertain by as much
  vec3 normal;      // unit length, towards the camera; 0 where there is none: not part of the geometric term
};

/// Sums of one Gauss-Newton step over pixels: the normal equations, with the weights in, and for each of the two terms
/// the weighted squares that its scale follows from.
struct AlignSums {
  float normal[21];         // J^T W J, upper triangle by rows (lib/triangle.glsl); translation first, then rotation
  float slope[6];           // J^T W r
  float squares_colour;
  float squares_depth;
  float pixels_colour;
  float pixels_depth;
};

/// The numbers of AlignSums, and where some of them lie.
SHARED_CONST uint ALIGN_SLOPE = 21;
SHARED_CONST uint ALIGN_SQUARES = 27;
SHARED_CONST uint ALIGN_PIXELS = 29;
SHARED_CONST uint ALIGN_VALUES = 31;

/// What a frame is aligned to: source 0 is the render, the others are the images of keyframes.
SHARED_CONST uint ALIGN_REFERENCES = 4;
SHARED_CONST uint ALIGN_SOURCES = 1 + ALIGN_REFERENCES;

/// Scales of the residuals' t-distributions, squared.
struct AlignScales {
  float colour;
  float depth;
};

/// The alignment on its way.
struct AlignState {
  CameraState base;        // the camera that was rendered; the motion since:
  vec3 rotation0;
  vec3 rotation1;
  vec3 rotation2;
  vec3 translation;
  AlignScales scales[ALIGN_SOURCES];
  CameraState references[ALIGN_REFERENCES];   // the keyframes' cameras
  CameraState best_camera;
  float best_loss;
  float best_valid;        // depth pixels that took part at the best pose, of those with sensor depth
  float best_explained;    // pixels whose depth the render explains at the best pose, of those
  float best_through;      // pixels where the sensor sees through the render, of those
};

/// Pixels that one invocation of align_sums adds up.
SHARED_CONST uint ALIGN_STRIP = 32;

SHARED_TYPES_END

#endif
