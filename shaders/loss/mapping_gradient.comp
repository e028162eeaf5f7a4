#version 460
#extension GL_GOOGLE_include_directive : require
#include "mapping_gradient.h"
#include "intensity.glsl"
#include "ssim.glsl"
#include "pixel_upstream.glsl"

// The blurred slopes of the invocation's pixels: where a loop that is not unrolled can find them.
shared SsimSlopes blurred_slopes[SSIM_STRIP * gl_WorkGroupSize.x];

// One invocation per strip of STRIP pixels of a column, as in ssim_columns: finishes the blur of SSIM's slopes and adds
// the L1 terms. A pixel without sensor depth has no part in them, so that
// no Gaussian grows where nothing was measured; one without a median none in L_align.
void main() {
  const uint strips = (params.height + STRIP - 1) / STRIP;
  const uint i = gl_GlobalInvocationID.x;
  if (i >= strips * params.width) return;
  const uint column = i % params.width;
  const int first = int(i / params.width) * STRIP;

  SsimSlopes blurred[STRIP];
  [[unroll]] for (int o = 0; o < STRIP; ++o) blurred[o] = SsimSlopes(0.0, 0.0, 0.0);
  [[unroll]] for (int p = 0; p < STRIP + 2 * WINDOW_RADIUS; ++p) {
    const int row = first + p - WINDOW_RADIUS;
    const bool inside = row >= 0 && row < int(params.height);
    const SsimSlopes s = row_slopes[uint(clamp(row, 0, int(params.height) - 1)) * params.width + column];
    [[unroll]] for (int o = 0; o < STRIP; ++o) {
      if (p < o || p > o + 2 * WINDOW_RADIUS) continue;  // decided when the loops are unrolled
      const float w = inside ? WINDOW[p - o] : 0.0;
      blurred[o].x += w * s.x;
      blurred[o].xx += w * s.xx;
      blurred[o].xy += w * s.xy;
    }
  }

  [[unroll]] for (int o = 0; o < STRIP; ++o)
    blurred_slopes[uint(o) * gl_WorkGroupSize.x + gl_LocalInvocationID.x] = blurred[o];

  const float per_valid = 1 / max(params.valid_pixels, 1.0), per_channel = per_valid / 3;
  const float per_median = 1 / max(float(median_count[0]), 1.0);
  LossSums sums = LossSums(0.0, ssim_partials[i], 0.0, 0.0, 0.0, 0.0);
  // Unrolled, this would take compilers seconds and save nothing.
  [[dont_unroll]] for (int o = 0; o < min(STRIP, int(params.height) - first); ++o) {
    const SsimSlopes slopes = blurred_slopes[uint(o) * gl_WorkGroupSize.x + gl_LocalInvocationID.x];
    const uint at = uint(first + o) * params.width + column;
    const vec4 image = colour_opacity[at];
    const vec4 geo = geometry[at];
    const vec3 target = params.gains * unpackUnorm4x8(sensor_colour[at]).rgb;
    const float sensor = sensor_depth[at];
    const float depth = NORMALISED_DEPTH == 0 ? geo.x : (image.a > 0 ? geo.x / image.a : 0.0);

    PixelGradient g = PixelGradient(vec3(0), 0.0, 0.0, 0.0, 0.0, 0.0);
    float g_depth = 0;
    if (sensor > 0) {
      const vec3 difference = image.rgb - target;
      const float similarity = slopes.x + 2 * intensity_of(image.rgb) * slopes.xx + intensity_of(target) * slopes.xy;
      g.colour = params.w_colour * per_channel * sign(difference) - params.w_ssim * per_valid * similarity * INTENSITY;
      sums.colour += abs(difference.r) + abs(difference.g) + abs(difference.b);
      g_depth += params.w_depth * per_valid * sign(depth - sensor);
      g.uncertainty = params.w_variance * per_valid;
      sums.depth += abs(depth - sensor);
      sums.variance += geo.z;
    }
    if (geo.y > 0) {
      const float s = params.w_align * per_median * sign(depth - geo.y);
      g_depth += s;
      g.depth_median = -s;
      sums.align += abs(depth - geo.y);
      sums.medians += 1;
    }
    if (NORMALISED_DEPTH == 0) g.depth = g_depth;
    else g.depth_normalised = g_depth;
    pixel_upstream[at] = upstream_of(g, image, geo, sensor, params.background);
  }
  loss_partials[i] = sums;
}
