// Records that the splatting passes share. Units: metres and pixels; conventions: docs/method.md.
#ifndef SUREFIELD_SHARED_SPLAT_TYPES_H
#define SUREFIELD_SHARED_SPLAT_TYPES_H

#include "language.h"

SHARED_TYPES_BEGIN

/// A camera as kernels read it: x_c = R x_w + t with R given by rows, then u = fx x/z + cx, v = fy y/z + cy.
struct CameraState {
  vec3 rotation0;
  vec3 rotation1;
  vec3 rotation2;
  vec3 translation;
  float fx;
  float fy;
  float cx;
  float cy;
  uint width;
  uint height;
};

/// A Gaussian projected to the image.
struct Splat {
  vec2 centre;    // pixels
  vec3 conic;     // inverse of the 2D covariance: xx, xy, yy
  float opacity;  // after the sigmoid; 0 where culled
  vec3 colour;
  float depth;    // camera z of the centre
  vec2 slope;     // d(depth)/d(pixel): over its footprint, a Gaussian's depth is that of a plane
};

/// What a tile sums up for one of its Gaussians while going backward, with p = -d^T conic d / 2 the exponent at pixel
/// offset d = pixel - centre, and g = dL/dp: everything that does not need the pixel is left to project_backward.
struct SplatGradient {
  float exponent;   // sum g
  vec2 first;       // sum g d
  vec3 second;      // sum g (dx dx, dx dy, dy dy)
  vec3 colour;      // dL/dcolour
  float depth;      // dL/dz
  vec2 depth_first; // sum over pixels of dL/dz(d) d, with z(d) = depth + slope . d
};

/// A SplatGradient as it is stored for each instance, in two records: a device binds so many bytes of an array at once, and
/// there are millions of instances.
struct FootprintGradient {
  float exponent;
  vec2 first;
  vec3 second;
};
struct LayerGradient {
  vec3 colour;
  float depth;
  vec2 depth_first;
};

/// Gradient of the loss with respect to what is rendered at one pixel.
struct PixelGradient {
  vec3 colour;
  float opacity;
  float depth;             // D_alpha
  float depth_normalised;  // D_alpha / O
  float depth_median;
  float uncertainty;
};

/// A PixelGradient together with what was rendered there, as going backward needs it for every Gaussian: with s_i =
/// dL/dw_i = colour . c_i + depth z_i + uncertainty (z_i - D)^2 + constant the value of Gaussian i's weight w_i.
struct PixelUpstream {
  vec3 colour;
  float depth;        // dL/dD_alpha, with the part through the normalised depth
  float constant;     // the part of s_i that does not depend on the Gaussian
  float total;        // sum w_i s_i
  float median;
  float uncertainty;
};

/// Gradient of the loss with respect to a Gaussian's parameters, as optimised (SH apart).
struct GaussianGradient {
  vec3 mean;
  vec3 log_scale;
  vec4 rotation;
  float opacity_logit;
};

/// Gradient of the loss with respect to the pose: R <- Exp(phi) R and t apart, {so(3)|T}.
struct PoseGradient {
  vec3 rotation;
  vec3 translation;
};

/// Device-side bookkeeping of the views of one submission.
struct RenderStatus {
  uint visible;    // Gaussians that touch the image, of the last view
  uint instances;  // (Gaussian, tile) pairs, of the last view
  uint overflow;   // 1 once a view had more instances than room; passes that update anything then do nothing
  uint needed;     // the most instances that a view without room had
  uint completed;  // views rendered before the first that had no room
};

/// What a Gaussian's dominated pixels add up to (paper eq. 13), in whole steps so that the order does not matter.
struct UncertaintySum {
  uint low;     // sum of alpha T (D - z)^2, in steps of 1 / UNCERTAINTY_STEPS: 64 bits in two words
  uint high;
  uint pixels;  // that it dominates and where the sensor's depth is valid
};

SHARED_CONST float UNCERTAINTY_STEPS = 16777216.0f;  // of a square metre: to 2^-24 m^2, a quarter of a millimetre squared
SHARED_CONST float LARGEST_UNCERTAINTY = 255.0f;     // of a pixel, m^2; what fits one word

// How a Gaussian of a rebuilt map came about, in the top bits of its source's index.
SHARED_CONST uint SOURCE_KEPT = 0u << 30;
SHARED_CONST uint SOURCE_CLONE = 1u << 30;
SHARED_CONST uint SOURCE_SPLIT = 2u << 30;
SHARED_CONST uint SOURCE_KIND = 3u << 30;

SHARED_TYPES_END

#endif
