#version 460
#extension GL_GOOGLE_include_directive : require
#include "update_gaussians.h"
#include "adam.glsl"

// One invocation per visible Gaussian. Those out of view keep their parameters and moments; each counts its own steps,
// so that a newborn's first ones are as well corrected as anyone's. A gradient that is not a number is ignored.
void main() {
  const uint k = gl_GlobalInvocationID.x;
  if (k >= visible_count[0] || status[0].overflow != 0) return;
  const uint i = visible_ids[k];
  const GaussianGradient g = gaussian_gradients[i];
  const float probe = dot(g.mean, g.mean) + dot(g.log_scale, g.log_scale) + dot(g.rotation, g.rotation) +
                      g.opacity_logit * g.opacity_logit;
  if (isnan(probe) || isinf(probe)) return;
  const uint t = steps[i] + 1;
  steps[i] = t;
  const vec2 corrections = adam_corrections(t);
  vec3 m = means_m[i], v = means_v[i];
  means[i] -= params.rate_mean * adam_step(g.mean, m, v, corrections);
  means_m[i] = m;
  means_v[i] = v;
  m = log_scales_m[i];
  v = log_scales_v[i];
  log_scales[i] -= params.rate_log_scale * adam_step(g.log_scale, m, v, corrections);
  log_scales_m[i] = m;
  log_scales_v[i] = v;
  vec4 m4 = rotations_m[i], v4 = rotations_v[i];
  rotations[i] -= params.rate_rotation * adam_step(g.rotation, m4, v4, corrections);
  rotations_m[i] = m4;
  rotations_v[i] = v4;
  float m1 = opacity_logits_m[i], v1 = opacity_logits_v[i];
  opacity_logits[i] -= params.rate_opacity * adam_step(g.opacity_logit, m1, v1, corrections);
  opacity_logits_m[i] = m1;
  opacity_logits_v[i] = v1;
}
