#version 460
#extension GL_GOOGLE_include_directive : require
#include "project_backward.h"
#include "quaternion.glsl"
#include "projection.glsl"
#include "sh.glsl"
#include "project_backward.glsl"

// One invocation per visible Gaussian: sums its instances' slots, which lie side by side, in their fixed order, and
// carries the sum on to every parameter. L_iso (paper eq. 17) is added here, since it needs no pixel. The pose gradient
// is summed over the subgroup, one partial each.
void main() {
  const uint v = gl_GlobalInvocationID.x;
  const bool active_lane = v < visible_count[0] && status[0].overflow == 0;
  PoseGradient pose = PoseGradient(vec3(0), vec3(0));
  if (active_lane) {
    const uint id = visible_ids[v];
    SplatGradient sum = SplatGradient(0.0, vec2(0), vec3(0), vec3(0), 0.0, vec2(0));
    const uint begin = instance_offsets[id], end = begin + tile_counts[id];
    for (uint slot = begin; slot < end; ++slot) {
      const FootprintGradient f = footprint_gradients[slot];
      sum.exponent += f.exponent;
      sum.first += f.first;
      sum.second += f.second;
      const LayerGradient l = layer_gradients[slot];
      sum.colour += l.colour;
      sum.depth += l.depth;
      sum.depth_first += l.depth_first;
    }

    const CameraState c = camera[0];
    const Splat s = splats[id];
    const vec3 mean = means[id], log_scale = log_scales[id];
    const vec4 raw = rotations[id];
    const mat3 V = camera_axes(c, raw, log_scale);
    // The clamp of the colour at 0 passes no gradient.
    const vec3 g_colour = mix(sum.colour, vec3(0), equal(s.colour, vec3(0)));
    const vec3 direction = mean + transpose(camera_rotation(c)) * c.translation;
    const ProjectionGradient g =
        project_backward(c, mean, sampling[id], V, s, sum, direction_gradient(id, direction, g_colour));
    pose = g.pose;

    GaussianGradient result;
    result.mean = g.mean;
    // V = R Rq S: the gradient of S's diagonal, times S for the logarithm, and that of Rq.
    result.log_scale = vec3(dot(V[0], g.axes[0]), dot(V[1], g.axes[1]), dot(V[2], g.axes[2]));
    const vec3 scale = exp(log_scale);
    mat3 g_rotation = transpose(camera_rotation(c)) * g.axes;
    g_rotation[0] *= scale.x;
    g_rotation[1] *= scale.y;
    g_rotation[2] *= scale.z;
    const float inverse_length = inversesqrt(dot(raw, raw));
    const vec4 q = raw * inverse_length;
    const vec4 g_q = rotation_backward(q, g_rotation);
    result.rotation = (g_q - q * dot(q, g_q)) * inverse_length;
    // alpha = o exp(p): dL/do = sum g / o, and do/dlogit = o (1 - o).
    result.opacity_logit = sum.exponent * (1 - s.opacity);

    const float largest = max(log_scale.x, max(log_scale.y, log_scale.z));
    const float smallest = min(log_scale.x, min(log_scale.y, log_scale.z));
    const float ratio = exp(largest - smallest);
    if (ratio > params.isotropy_epsilon) {
      const float slope = params.weight_isotropy * ratio / float(visible_count[0]);
      const uint up = log_scale.x == largest ? 0 : (log_scale.y == largest ? 1 : 2);
      const uint down = log_scale.z == smallest ? 2 : (log_scale.y == smallest ? 1 : 0);
      result.log_scale += slope * (vec3(up == 0, up == 1, up == 2) - vec3(down == 0, down == 1, down == 2));
    }
    gaussian_gradients[id] = result;

    sh_gradients[id * SH_COUNT] = SH0 * g_colour;
    if (SH_DEGREE > 0) {
      float basis[16];
      sh_basis(normalize(direction), basis);
      [[unroll]] for (uint k = 1; k < SH_COUNT; ++k) sh_gradients[id * SH_COUNT + k] = basis[k] * g_colour;
    }
    const vec2 g_centre = centre_gradient(s, sum);
    // In units of the image's half size, as 3DGS counts it, so that thresholds do not depend on the resolution.
    if (sum.exponent != 0) sampling[id] = min(sampling[id], s.depth * inversesqrt(c.fx * c.fy));
    densification[id] += vec2(length(g_centre * 0.5 * vec2(c.width, c.height)), 1);
  }
  [[unroll]] for (uint bit = 0; bit < 6; ++bit) {
    const uint step = 1u << bit;
    if (step >= gl_SubgroupSize) continue;
    pose.rotation += subgroupShuffleXor(pose.rotation, step);
    pose.translation += subgroupShuffleXor(pose.translation, step);
  }
  if (gl_SubgroupInvocationID == 0) pose_partials[gl_WorkGroupID.x * gl_NumSubgroups + gl_SubgroupID] = pose;
}
