// The errors of measured depth (engine/types/depth_noise.h).

/// Standard deviation at depth z, metres; `noise` has the constant, linear and quadratic part.
float sigma_at(vec3 noise, float z) {
  return noise.x + z * (noise.y + z * noise.z);
}
