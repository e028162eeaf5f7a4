#version 460
#extension GL_GOOGLE_include_directive : require
#include "split_children.h"
#include "quaternion.glsl"

/// A hash of good quality (PCG, O'Neill 2014).
uint hash(uint x) {
  x = x * 747796405u + 2891336453u;
  x = ((x >> ((x >> 28) + 4)) ^ x) * 277803737u;
  return (x >> 22) ^ x;
}

/// Two independent normal numbers (Box and Muller).
vec2 normal_pair(uint key) {
  const float u = (float(hash(key) >> 8) + 0.5) / 16777216.0, angle = float(hash(key + 0x9E3779B9u)) * 1.4629180792671596e-9;
  return sqrt(-2 * log(u)) * vec2(cos(angle), sin(angle));
}

// One invocation per Gaussian of the new map. A child lies where a draw from its parent falls, and is 1.6 times smaller
// (3D Gaussian splatting). The draw depends on the seed and on the child's place alone.
void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= params.count || (sources[i] & SOURCE_KIND) != SOURCE_SPLIT) return;
  const uint key = hash(i ^ hash(params.seed));
  const vec3 draw = vec3(normal_pair(key), normal_pair(key + 1).x);
  means[i] += rotation_of(normalize(rotations[i])) * (exp(log_scales[i]) * draw);
  log_scales[i] -= log(1.6);
}
