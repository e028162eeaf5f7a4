#version 460
#extension GL_GOOGLE_include_directive : require
#include "track_gradient.h"
#include "pixel_upstream.glsl"

// One invocation per pixel. The masks (residuals below their limits) are constants of the gradient.
void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= params.pixels) return;
  const vec2 residual = residuals[i], limit = limits[0];
  const vec4 image = colour_opacity[i], geo = geometry[i];
  const TrackSums s = sums[0];
  PixelGradient g = PixelGradient(vec3(0), 0.0, 0.0, 0.0, 0.0, 0.0);
  if (residual.x >= 0 && residual.x < limit.x)
    g.colour = params.weight_colour / (3 * s.colour_pixels) *
               sign(image.rgb - unpackUnorm4x8(sensor_colour[i]).rgb);
  if (residual.y >= 0 && residual.y < limit.y) {
    const float scale = params.weight_depth / s.depth_pixels;
    const float depth = NORMALISED_DEPTH == 1 ? geo.x / max(image.a, 1e-6) : geo.x;
    const float slope = scale * sign(depth - sensor_depth[i]);
    if (NORMALISED_DEPTH == 1) g.depth_normalised = slope;
    else g.depth = slope;
  }
  pixel_upstream[i] = upstream_of(g, image, geo, 0, params.background);
}
