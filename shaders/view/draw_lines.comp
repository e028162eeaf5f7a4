#version 460
#extension GL_GOOGLE_include_directive : require
#include "draw_lines.h"

/// How much of a pixel a line covers.
float coverage(LineSegment s, float distance_to_line) {
  return clamp(s.half_width + 0.5 - distance_to_line, 0.0, 1.0);
}

// One workgroup per tile of LINE_TILE x LINE_TILE pixels that has lines; an invocation draws every line of the tile on its
// pixel, in their order.
void main() {
  const LineTile tile = line_tiles[gl_WorkGroupID.x];
  const uint place = gl_LocalInvocationID.x;
  const uvec2 pixel = uvec2(tile.x, tile.y) * LINE_TILE + uvec2(place % LINE_TILE, place / LINE_TILE);
  if (pixel.x >= params.size.x || pixel.y >= params.size.y) return;
  const uint at = pixel.y * params.size.x + pixel.x;

  // The map hides what lies behind it by a fiftieth of its depth, where most of the light is stopped.
  const float opacity = colour_opacity[at].a;
  const float map_depth = opacity > 0.5 ? geometry[at].x / opacity : 0.0;
  vec3 colour = unpackUnorm4x8(picture[at]).rgb;
  for (uint i = tile.begin; i < tile.end; ++i) {
    const LineSegment s = segments[tile_segments[i]];
    const vec2 along = s.to - s.from, offset = vec2(pixel) - s.from;
    const float t = clamp(dot(offset, along) / max(dot(along, along), 1e-12), 0.0, 1.0);
    const bool hidden = mix(s.inverse_depth_from, s.inverse_depth_to, t) * map_depth < 0.98 && map_depth > 0;
    const vec4 paint = unpackUnorm4x8(s.colour);
    const float alpha = paint.a * coverage(s, length(offset - t * along)) * (hidden ? params.hidden : 1.0);
    colour = mix(colour, paint.rgb, alpha);
  }
  picture[at] = packUnorm4x8(vec4(colour, 1));
}
