#version 460
#extension GL_GOOGLE_include_directive : require
#include "align_sums.h"
#include "depth_noise.glsl"
#include "pyramid.glsl"
#include "crossed_derivatives.glsl"
#include "triangle.glsl"

const float T_FREEDOM = 5;        // of the residuals' t-distributions
const float SAME_SURFACE = 0.05;  // of the depth
const float DEPTH_GATE = 0.2;     // of the depth: farther apart, the frame shows another surface

/// Weight of a residual from a t-distribution of this squared scale, the division by the scale not yet included.
float t_weight(float residual, float variance) {
  return (T_FREEDOM + 1) / (T_FREEDOM + residual * residual / variance);
}

/// The derivative of a residual by the translation and the rotation.
struct Derivative {
  vec3 by_translation;
  vec3 by_rotation;
};

/// Adds one residual, with its derivative, and for evidence with the derivative as the points tell it.
void add_residual(inout AlignSums s, float residual, Derivative own, Derivative other, float weight) {
  const float J[6] = float[](own.by_translation.x, own.by_translation.y, own.by_translation.z,  //
                             own.by_rotation.x, own.by_rotation.y, own.by_rotation.z);
  const float K[6] = float[](other.by_translation.x, other.by_translation.y, other.by_translation.z,  //
                             other.by_rotation.x, other.by_rotation.y, other.by_rotation.z);
  [[unroll]] for (uint row = 0; row < 6; ++row) {
    const float weighted = weight * J[row];
    s.slope[row] += weighted * residual;
    [[unroll]] for (uint column = 0; column < 6; ++column) {
      if (column < row) continue;  // decided when the loops are unrolled
      s.normal[triangle_at(row, column)] +=
          CROSSED == 1 ? 0.5 * (weighted * K[column] + weight * K[row] * J[column]) : weighted * J[column];
    }
  }
}

/// Sums over the subgroup, in every lane.
AlignSums subgroup_sums(AlignSums s) {
  [[unroll]] for (uint bit = 0; bit < 6; ++bit) {
    const uint step = 1u << bit;
    if (step >= gl_SubgroupSize) continue;
    [[unroll]] for (uint n = 0; n < 21; ++n) s.normal[n] += subgroupShuffleXor(s.normal[n], step);
    [[unroll]] for (uint n = 0; n < 6; ++n) s.slope[n] += subgroupShuffleXor(s.slope[n], step);
    s.squares_colour += subgroupShuffleXor(s.squares_colour, step);
    s.squares_depth += subgroupShuffleXor(s.squares_depth, step);
    s.pixels_colour += subgroupShuffleXor(s.pixels_colour, step);
    s.pixels_depth += subgroupShuffleXor(s.pixels_depth, step);
  }
  return s;
}

// One invocation per ALIGN_STRIP of the pixels that take part, `strips` times `stride` apart. A point of the render, or of a keyframe,
// moves with the camera and is looked up in the sensor's image: its intensity between four pixels, its depth at the nearest
// one. The residuals are the difference of intensity, and the distance to the point that the sensor measured along the
// normal, in standard deviations of the sensor. Each subgroup writes one sum.
void main() {
  const uint strip = gl_GlobalInvocationID.x;
  const vec4 k = intrinsics_at(state[0].base, params.level);
  mat3 R = transpose(mat3(state[0].rotation0, state[0].rotation1, state[0].rotation2));
  vec3 t = state[0].translation;
  if (FROM_KEYFRAME == 1) {
    // From the keyframe's camera to the base's, and on.
    const CameraState base = state[0].base, reference = state[0].references[params.source - 1];
    const mat3 turn = transpose(mat3(base.rotation0, base.rotation1, base.rotation2)) *
                      mat3(reference.rotation0, reference.rotation1, reference.rotation2);
    t += R * (base.translation - turn * reference.translation);
    R = R * turn;
  }
  const float variance_colour = state[0].scales[params.source].colour;
  const float variance_depth = state[0].scales[params.source].depth;
  const uint pixels = strip < params.strips ? params.width * params.height : 0;

  AlignSums s;
  [[unroll]] for (uint n = 0; n < 21; ++n) s.normal[n] = 0;
  [[unroll]] for (uint n = 0; n < 6; ++n) s.slope[n] = 0;
  s.squares_colour = s.squares_depth = s.pixels_colour = s.pixels_depth = 0;

  for (uint n = 0; n < ALIGN_STRIP; ++n) {
    const uint i = (strip + n * params.strips) * params.stride;
    const AlignPoint point = points[i < pixels ? i : 0];
    const bool unknown = point.depth < 0;
    const float far = abs(point.depth);
    const vec3 Y = R * unproject(k, vec2(pixel_at(i, params.width)), far) + t;
    const float z = max(Y.z, 1e-3);
    const vec2 seen = k.xy * Y.xy / z + k.zw;
    const vec2 last = vec2(params.width - 1, params.height - 1);
    const bool visible = i < pixels && far > 0 && Y.z > 1e-3 && all(greaterThanEqual(seen, vec2(0))) &&
                         all(lessThan(seen, last));
    const vec2 place = visible ? seen : vec2(0);
    const uvec2 corner = uvec2(place);
    const vec2 part = place - vec2(corner);
    const uint at = corner.y * params.width + corner.x;
    const vec2 p00 = sensor[at], p10 = sensor[at + 1], p01 = sensor[at + params.width],
               p11 = sensor[at + params.width + 1];

    const bool right = part.x >= 0.5, lower = part.y >= 0.5;
    const float depth = right ? (lower ? p11.y : p10.y) : (lower ? p01.y : p00.y);
    const float top = mix(p00.x, p10.x, part.x), bottom = mix(p01.x, p11.x, part.x);
    const float off = mix(top, bottom, part.y) - point.intensity;
    const vec2 slope = k.xy / z * vec2(mix(p10.x - p00.x, p11.x - p01.x, part.y), bottom - top);
    const vec3 by_point = vec3(slope, -dot(slope, Y.xy) / z);
    // What the keyframe saw may be hidden by now.
    const bool shown = visible && (FROM_KEYFRAME == 0 || depth == 0 || unknown || abs(depth - Y.z) < SAME_SURFACE * Y.z);
    // A point whose depth is uncertain is uncertain along its ray, and so is the intensity that it should have.
    const float sigma = unknown ? far : sigma_at(params.noise, far);
    const float by_depth = sigma * dot(by_point, R * unproject(k, vec2(pixel_at(i, params.width)), 1.0));
    const float certainty = variance_colour / (variance_colour + by_depth * by_depth);
    const float w_colour = shown ? certainty * t_weight(sqrt(certainty) * off, variance_colour) : 0;
    s.squares_colour += w_colour * off * off;
    s.pixels_colour += shown ? 1 : 0;
    const Derivative light = Derivative(by_point, cross(Y, by_point));
    Derivative points_light = light;
    if (CROSSED == 1 && shown) {
      const vec3 by_source = R * intensity_slope(i, k, params.width, params.height);
      points_light = Derivative(by_source, cross(Y, by_source));
    }
    add_residual(s, off, light, points_light, params.weight * w_colour / variance_colour);

    const vec3 S = unproject(k, vec2(corner) + vec2(right, lower), depth);
    const bool measured = visible && depth > 0 && abs(depth - Y.z) < DEPTH_GATE * Y.z && point.normal != vec3(0);
    const vec3 m = R * point.normal;
    const float scale = 1 / sigma_at(params.noise, z);
    const float distance = measured ? scale * dot(m, Y - S) : 0;
    const float w_depth = measured ? t_weight(distance, variance_depth) : 0;
    s.squares_depth += w_depth * distance * distance;
    s.pixels_depth += measured ? 1 : 0;
    const Derivative shape = Derivative(scale * m, scale * cross(S, m));
    Derivative frame_shape = shape;
    if (CROSSED == 1 && measured) {
      const vec3 n = scale * sensor_normal(corner + uvec2(right, lower), k, params.width, params.height, dot(m, S));
      frame_shape = Derivative(n, cross(S, n));
    }
    add_residual(s, distance, shape, frame_shape, params.weight * params.balance * w_depth / variance_depth);
  }
  s = subgroup_sums(s);
  if (gl_SubgroupInvocationID == 0) partial_sums[params.first + gl_WorkGroupID.x * gl_NumSubgroups + gl_SubgroupID] = s;
}
