#version 460
#extension GL_GOOGLE_include_directive : require
#include "cast_scene.h"
#include "scene_shapes.glsl"
#include "scene_textures.glsl"

const float SHADOW_OFFSET = 5e-4;  // m, keeps a surface out of its own shadow

shared uint tile_shapes[SCENE_SHAPES / 32];  // one bit per shape that the tile's rays may meet

struct Ray {
  vec3 origin;
  vec3 direction;  // camera z is 1: the distance along it is the depth
};

/// The pose at a time from 0 to 1, over which so many of `poses` from `first` on are spaced.
CastPose pose_at(float time, uint first, uint count) {
  const float at = clamp(time, 0, 1) * float(count - 1);
  const uint before = min(uint(at), count - 1), after = min(before + 1, count - 1);
  const CastPose a = poses[first + before], b = poses[first + after];
  const float f = at - float(before);
  return CastPose(mix(a.origin, b.origin, f), mix(a.right, b.right, f), mix(a.down, b.down, f),
                  mix(a.forward, b.forward, f));
}

Ray ray_at(CastPose pose, vec2 pixel) {
  const vec2 slope = (pixel - vec2(params.cx, params.cy)) / vec2(params.fx, params.fy);
  return Ray(pose.origin, slope.x * pose.right + slope.y * pose.down + pose.forward);
}

void find_tile_shapes(uvec2 tile) {
  for (uint i = gl_LocalInvocationIndex; i < SCENE_SHAPES / 32; i += gl_WorkGroupSize.x) tile_shapes[i] = 0;
  barrier();
  const CastPose pose = poses[0];
  const vec2 low = vec2(tile * CAST_TILE) - 0.5, high = low + float(CAST_TILE);
  const vec3 axis = normalize(ray_at(pose, 0.5 * (low + high)).direction);
  float spread = 0;
  [[unroll]] for (int corner = 0; corner < 4; ++corner) {
    const vec3 d = ray_at(pose, mix(low, high, vec2(corner & 1, corner >> 1))).direction;
    spread = max(spread, length(cross(d, axis)) / dot(d, axis));
  }
  spread = tan(atan(spread) + params.swing) + 1e-4;
  for (uint i = gl_LocalInvocationIndex; i < params.shapes; i += gl_WorkGroupSize.x) {
    if (touches_cone(shapes[i], pose.origin, params.wander, axis, spread)) atomicOr(tile_shapes[i / 32], 1u << (i % 32));
  }
  barrier();
}

// Rays that a pixel follows at once, so that a body is looked up once for all: that of depth, and four of colour.
const int RAYS = 5;

struct Hits {
  float depths[RAYS];
  uint shapes[RAYS];
};

void keep_nearest(inout Hits hits, int r, vec2 inside, uint shape) {
  const bool first = inside.x > 0 && inside.x < inside.y && inside.x < hits.depths[r];
  hits.depths[r] = first ? inside.x : hits.depths[r];
  hits.shapes[r] = first ? shape : hits.shapes[r];
}

// The first surfaces along rays of the tile. Of two at the same depth, that of lower number. Boxes come first among the
// shapes, so that they are spared the arithmetic of round bodies.
Hits find_nearest(Ray rays[RAYS]) {
  Hits hits;
  [[unroll]] for (int r = 0; r < RAYS; ++r) {
    hits.depths[r] = BEYOND;
    hits.shapes[r] = NO_SHAPE;
  }
  for (uint word = 0; word * 32 < params.first_round; ++word) {
    uint bits = tile_shapes[word];
    if (params.first_round < word * 32 + 32) bits &= (1u << (params.first_round % 32)) - 1;
    while (bits != 0) {
      const uint i = word * 32 + findLSB(bits);
      bits &= bits - 1;
      const SceneShape shape = shapes[i];
      [[unroll]] for (int r = 0; r < RAYS; ++r) {
        const vec3 o = to_unit(shape, rays[r].origin - shape.centre), d = to_unit(shape, rays[r].direction);
        keep_nearest(hits, r, crossing_cube(o, d), i);
      }
    }
  }
  for (uint word = params.first_round / 32; word * 32 < params.shapes; ++word) {
    uint bits = tile_shapes[word];
    if (word == params.first_round / 32) bits &= ~0u << (params.first_round % 32);
    while (bits != 0) {
      const uint i = word * 32 + findLSB(bits);
      bits &= bits - 1;
      const SceneShape shape = shapes[i];
      [[unroll]] for (int r = 0; r < RAYS; ++r)
        keep_nearest(hits, r, crossing(shape, rays[r].origin, rays[r].direction), i);
    }
  }
  return hits;
}

uint cell_of_direction(vec3 d) {
  const vec3 size = abs(d);
  const bool x = size.x >= size.y && size.x >= size.z, y = !x && size.y >= size.z;
  const float major = x ? d.x : y ? d.y : d.z;
  const vec2 minor = (x ? d.yz : y ? d.xz : d.xy) / abs(major);
  const uint face = (x ? 0 : y ? 2 : 4) + (major > 0 ? 0 : 1);
  const uvec2 cell = uvec2(clamp((0.5 * minor + 0.5) * LIGHT_CELLS, vec2(0), vec2(LIGHT_CELLS - 1)));
  return (face * LIGHT_CELLS + cell.y) * LIGHT_CELLS + cell.x;
}

bool stands_between(uint shape, vec3 point, vec3 to_light) {
  const vec2 inside = crossing(shapes[shape], point, to_light);
  return max(inside.x, 0) < min(inside.y, 1);
}

bool in_shadow(uint light, vec3 point, vec3 to_light, float away) {
  const uvec2 range = light_cells[light * 6 * LIGHT_CELLS * LIGHT_CELLS + cell_of_direction(-to_light)];
  bool hidden = false;
  for (uint k = 0; k < range.y && !hidden; ++k) {
    const LightEntry entry = light_entries[range.x + k];
    if (entry.nearest > away) break;  // as are all that follow
    hidden = stands_between(entry.shape, point, to_light);
  }
  for (uint i = params.first_moving; i < params.shapes && !hidden; ++i) hidden = stands_between(i, point, to_light);
  return hidden;
}

// Light that a surface sends along -direction: ambient, and from each lamp a Lambert and a Blinn-Phong part.
vec3 shade(Ray ray, float depth, uint shape_index) {
  const SceneShape shape = shapes[shape_index];
  const SceneSurface surface = surfaces[shape_index];
  const SceneMaterial material = materials[surface.material];
  const vec3 point = ray.origin + depth * ray.direction;
  const vec3 normal = outward_normal(shape, point);
  const vec3 towards_eye = -normalize(ray.direction);
  // Four samples share a pixel: half its side is left to the texture, a little more against flicker.
  const float pixel = depth / params.fx / max(dot(normal, towards_eye), 0.15) * 0.6;
  const vec3 albedo = surface_colour(shape, surface, material, point, normal, pixel);

  vec3 diffuse = vec3(0.26, 0.27, 0.29) + vec3(0.09) * normal.z + vec3(0.03, 0.02, 0) * normal.x - 0.02 * normal.y;
  float gloss = 0;
  const vec3 start = point + SHADOW_OFFSET * normal;
  for (uint i = 0; i < params.lights; ++i) {
    const SceneLight light = lights[i];
    const vec3 to_light = light.position - start;
    const float away = length(to_light), cosine = dot(normal, to_light) / away;
    if (cosine <= 0 || away >= light.range) continue;
    const float ratio = away / light.range, window = 1 - ratio * ratio;
    const float strength = in_shadow(i, start, to_light, away) ? 0 : window * window / (1 + 0.35 * away * away);
    diffuse += strength * cosine * light.colour;
    const vec3 halfway = normalize(to_light / away + towards_eye);
    gloss += strength * pow(max(dot(normal, halfway), 0), material.shininess);
  }
  return albedo * mix(diffuse, vec3(1), material.emission) + material.gloss * gloss;
}

// Highlights are compressed softly; then the curve of sRGB, simplified.
vec3 develop(vec3 light) {
  return pow(1 - exp(-params.brightness * light), vec3(1 / 2.2));
}

// One workgroup works a tile of CAST_TILE x CAST_TILE pixels, one invocation a pixel.
void main() {
  find_tile_shapes(gl_WorkGroupID.xy);
  const uvec2 at = gl_WorkGroupID.xy * CAST_TILE +
                   uvec2(gl_LocalInvocationIndex % CAST_TILE, gl_LocalInvocationIndex / CAST_TILE);
  if (at.x >= params.width || at.y >= params.height) return;
  const uint index = at.y * params.width + at.x;
  vec3 sum = vec3(0);
  for (uint first = 0; first < params.samples; first += 4) {
    Ray rays[RAYS];
    rays[4] = ray_at(pose_at(float(at.y) / float(params.height), 0, params.depth_poses), vec2(at));
    [[unroll]] for (uint s = 0; s < 4; ++s) {
      // Samples of one pixel cover its quarters and, evenly but shifted at random, the time of its exposure.
      const float shift = random_at(ivec3(at, first + s), params.seed);
      const float time = params.readout * float(at.y) / float(params.height) +
                         params.exposure * (float(first + s) + shift) / float(params.samples);
      rays[s] = ray_at(pose_at(time, params.depth_poses, params.colour_poses), vec2(at) + vec2(s & 1, s >> 1) * 0.5 - 0.25);
    }
    const Hits hits = find_nearest(rays);
    if (first == 0) {
      depth[index] = hits.shapes[4] == NO_SHAPE ? 0 : hits.depths[4];
      hit_shapes[index] = hits.shapes[4];
    }
    for (uint s = 0; s < 4; ++s) {
      // Choices instead of an index, which would put the arrays into memory.
      Ray ray = rays[0];
      float distance_along = hits.depths[0];
      uint shape = hits.shapes[0];
      [[unroll]] for (int r = 1; r < 4; ++r) {
        if (s == r) {
          ray = rays[r];
          distance_along = hits.depths[r];
          shape = hits.shapes[r];
        }
      }
      if (shape != NO_SHAPE) sum += develop(shade(ray, distance_along, shape));
    }
  }
  colour[index] = packUnorm4x8(vec4(sum / float(params.samples), 1));
}
