// Derivatives of an alignment's residuals as the points tell them, where those of the step are what the frame tells. Noise
// looks like texture and relief: the square of a derivative counts it as knowledge of the pose. The product of the frame's
// with the points' does not, since the noise of two images is independent. Needs align_types.h, pyramid.glsl and `points`
// and `sensor` with its `width` and `height`.

const float SAME_RELIEF = 0.05;   // of the depth, between neighbours

/// How the intensity of point i grows per metre, as a covector in the frame of the camera that saw it; 0 at the border.
vec3 intensity_slope(uint i, vec4 k, uint width, uint height) {
  const uvec2 at = pixel_at(i, width);
  if (at.x == 0 || at.y == 0 || at.x + 1 >= width || at.y + 1 >= height) return vec3(0);
  const float far = abs(points[i].depth);
  const vec2 slope = 0.5 * k.xy / far * vec2(points[i + 1].intensity - points[i - 1].intensity,
                                             points[i + width].intensity - points[i - width].intensity);
  return vec3(slope, -dot(slope, (vec2(at) - k.zw) / k.xy));
}

/// The normal of the sensor's surface at a pixel that is `distance` from the camera's centre along it; linear in the inverse
/// depth of the neighbours, so not of unit length, but right in the mean. 0 at the border, at edges and at holes.
vec3 sensor_normal(uvec2 at, vec4 k, uint width, uint height, float distance) {
  if (at.x == 0 || at.y == 0 || at.x + 1 >= width || at.y + 1 >= height) return vec3(0);
  const uint i = at.y * width + at.x;
  const float z = sensor[i].y;
  const vec4 near = vec4(sensor[i - 1].y, sensor[i + 1].y, sensor[i - width].y, sensor[i + width].y);
  if (any(lessThanEqual(near, vec4(0))) || any(greaterThan(abs(near - z), vec4(SAME_RELIEF * z)))) return vec3(0);
  // The plane is where q . Y = 1.
  const vec2 q = 0.5 * k.xy * vec2(1 / near.y - 1 / near.x, 1 / near.w - 1 / near.z);
  return distance * vec3(q, 1 / z - dot(q, (vec2(at) - k.zw) / k.xy));
}
