// Records of the loss passes.
#ifndef SUREFIELD_SHARED_LOSS_TYPES_H
#define SUREFIELD_SHARED_LOSS_TYPES_H

#include "splat_types.h"

SHARED_TYPES_BEGIN

/// Pixels that one invocation works, side by side: of SSIM's passes, and of the masked sums of tracking.
SHARED_CONST uint SSIM_STRIP = 8;
SHARED_CONST uint SUM_STRIP = 16;

/// Horizontally blurred moments of the rendered (x) and the sensor's (y) intensity, for SSIM.
struct SsimMoments {
  float x;
  float y;
  float squares;   // xx + yy: SSIM needs no more of them
  float xy;
};

/// Derivatives of SSIM at a pixel with respect to the blurred moments x, xx and xy.
struct SsimSlopes {
  float x;
  float xx;
  float xy;
};

/// Sums over pixels of the terms of the mapping loss (paper eq. 18), before their weights and means.
struct LossSums {
  float colour;   // sum over channels of |I - I'|
  float ssim;     // of the intensities
  float depth;
  float align;
  float variance;
  float medians;  // pixels with a median depth
};

/// Masked sums of the tracking loss (paper eq. 19).
struct TrackSums {
  float colour;         // sum over pixels of the mean over channels of |I - I'|
  float colour_pixels;
  float depth;
  float depth_pixels;
};

/// Bins of the histogram of residuals: 64 to an octave from 2^-20 to 2^4.
SHARED_CONST uint RESIDUAL_OCTAVES = 24;
SHARED_CONST uint RESIDUAL_BINS_PER_OCTAVE = 64;
SHARED_CONST uint RESIDUAL_BINS = RESIDUAL_OCTAVES * RESIDUAL_BINS_PER_OCTAVE;

/// After the histograms of colour and of depth: counts of pixels whose sensor depth the render explains, and of those
/// where the sensor sees through what is rendered.
SHARED_CONST uint RESIDUAL_EXPLAINED = 2 * RESIDUAL_BINS;
SHARED_CONST uint RESIDUAL_THROUGH = RESIDUAL_EXPLAINED + 1;
SHARED_CONST uint RESIDUAL_COUNTS = RESIDUAL_THROUGH + 1;

/// Adam's state for a pose, in the tangent space {so(3)|T}.
struct PoseAdam {
  PoseGradient first_moment;
  PoseGradient second_moment;
  uint steps;
};

/// The pose being tracked and the best one so far.
struct TrackState {
  PoseAdam adam;
  CameraState best_camera;
  float best_loss;
  float best_valid;   // depth pixels that took part at the best pose, of those with sensor depth
  float best_explained;   // pixels whose depth the render explains at the best pose, of those
  float best_through;     // pixels where the sensor sees through the render, of those
  float last_update;  // largest rotation (radians) or translation (metres) of the last step
};

SHARED_TYPES_END

#endif
