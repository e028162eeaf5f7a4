#version 460
#extension GL_GOOGLE_include_directive : require
#include "align_points.h"
#include "pyramid.glsl"

const float SAME_SURFACE = 0.05;   // of the depth, between neighbours

// One invocation per pixel. The normal comes from the four neighbours; at the image border and at edges there is none.
void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= params.width * params.height) return;
  const uvec2 at = pixel_at(i, params.width);
  const uint x = at.x, y = at.y;
  const vec4 k = intrinsics_at(camera[0], params.level);
  const vec2 pixel = vec2(x, y);
  const float measured = image[i].y;
  AlignPoint point = AlignPoint(image[i].x, measured > 0 ? measured : measured < 0 ? 0 : -params.unknown, vec3(0));
  const bool inside = x > 0 && y > 0 && x + 1 < params.width && y + 1 < params.height;
  const uint row = inside ? params.width : 0, column = inside ? 1 : 0;
  const float left = image[i - column].y, right = image[i + column].y;
  const float above = image[i - row].y, below = image[i + row].y;
  const float nearest = min(min(left, right), min(above, below)), farthest = max(max(left, right), max(above, below));
  if (inside && point.depth > 0 && nearest > 0 && farthest - nearest < SAME_SURFACE * point.depth) {
    const vec3 across = unproject(k, pixel + vec2(1, 0), right) - unproject(k, pixel - vec2(1, 0), left);
    const vec3 down = unproject(k, pixel + vec2(0, 1), below) - unproject(k, pixel - vec2(0, 1), above);
    point.normal = normalize(cross(down, across));
  }
  points[i] = point;
}
