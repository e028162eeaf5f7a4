// The errors of measured depth (engine/types/depth_noise.h).

/// Standard deviation at depth z, metres; `noise` has the constant, linear and quadratic part.
float sigma_at(vec4 noise, float z) {
  return noise.x + z * (noise.y + z * noise.z);
}

/// Weight of a depth difference at measured depth z: 1 on average over the frame whose scale `noise.w` is.
float depth_weight(vec4 noise, float z) {
  return noise.w / sigma_at(noise, z);
}
