#version 460
#extension GL_GOOGLE_include_directive : require
#include "update_colours.h"
#include "adam.glsl"

const uint SH_COUNT = (SH_DEGREE + 1) * (SH_DEGREE + 1);

// One invocation per visible Gaussian.
void main() {
  const uint k = gl_GlobalInvocationID.x;
  if (k >= visible_count[0] || status[0].overflow != 0) return;
  const uint i = visible_ids[k];
  const vec2 corrections = adam_corrections(max(steps[i], 1u));
  for (uint c = 0; c < SH_COUNT; ++c) {
    const uint at = i * SH_COUNT + c;
    const vec3 g = sh_gradients[at];
    const float probe = dot(g, g);
    if (isnan(probe) || isinf(probe)) continue;
    vec3 m = sh_m[at], v = sh_v[at];
    sh[at] -= (c == 0 ? params.rate_base : params.rate_rest) * adam_step(g, m, v, corrections);
    sh_m[at] = m;
    sh_v[at] = v;
  }
}
