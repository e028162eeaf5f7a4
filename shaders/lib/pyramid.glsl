// Cameras of pyramid levels, each half as wide as the one before. Needs splat_types.h.

/// fx, fy, cx, cy of a level; pixel centres are at integer coordinates.
vec4 intrinsics_at(CameraState c, uint level) {
  const float scale = 1 / float(1u << level);
  return vec4(scale * c.fx, scale * c.fy, scale * (c.cx + 0.5) - 0.5, scale * (c.cy + 0.5) - 0.5);
}

/// The point of this depth seen at a pixel, in the camera frame.
vec3 unproject(vec4 intrinsics, vec2 pixel, float depth) {
  return vec3((pixel - intrinsics.zw) / intrinsics.xy, 1) * depth;
}

/// Column and row of pixel i of an image. By floating-point arithmetic, put right by one where it rounds: integer division
/// goes lane by lane on a CPU.
uvec2 pixel_at(uint i, uint width) {
  uint row = uint(float(i) / float(width));
  row = row * width > i ? row - 1 : row;
  row = i - row * width >= width ? row + 1 : row;
  return uvec2(i - row * width, row);
}
