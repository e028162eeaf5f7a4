// Procedural textures of the synthetic scenes. Detail that is finer than a pixel fades to its mean.
#ifndef SUREFIELD_LIB_SCENE_TEXTURES_GLSL
#define SUREFIELD_LIB_SCENE_TEXTURES_GLSL

const int NOISE_OCTAVES = 6;
const float JOINT_SHADE = 0.35;

uint mix_bits(uint h) {
  h = (h ^ (h >> 16)) * 0x7feb352du;
  h = (h ^ (h >> 15)) * 0x846ca68bu;
  return h ^ (h >> 16);
}

// Uniform in [0, 1), from the lattice point and the seed alone.
float random_at(ivec3 cell, uint seed) {
  const uvec3 c = uvec3(cell) * uvec3(0x8da6b343u, 0xd8163841u, 0xcb1ab31fu);
  return float(mix_bits(c.x ^ c.y ^ c.z ^ seed * 0x9e3779b9u) >> 8) * exp2(-24.0);
}

float random_at(ivec2 cell, uint seed) {
  return random_at(ivec3(cell, 0), seed);
}

// Random lattice values, blended smoothly; features of about one unit.
float smooth_noise(vec3 p, uint seed) {
  const ivec3 c = ivec3(floor(p));
  const vec3 f = smoothstep(0, 1, p - vec3(c));
  const vec2 low = mix(vec2(random_at(c, seed), random_at(c + ivec3(0, 1, 0), seed)),
                       vec2(random_at(c + ivec3(1, 0, 0), seed), random_at(c + ivec3(1, 1, 0), seed)), f.x);
  const vec2 high = mix(vec2(random_at(c + ivec3(0, 0, 1), seed), random_at(c + ivec3(0, 1, 1), seed)),
                        vec2(random_at(c + ivec3(1, 0, 1), seed), random_at(c + ivec3(1, 1, 1), seed)), f.x);
  return mix(mix(low.x, low.y, f.y), mix(high.x, high.y, f.y), f.z);
}

// Octaves of noise, -1 to 1. `pixel`: size of a pixel on the surface, m.
float layered_noise(SceneMaterial material, vec3 p, float pixel, uint seed) {
  vec3 frequency = material.noise_frequency;
  float weight = 1, sum = 0, total = 0;
  [[unroll]] for (int octave = 0; octave < NOISE_OCTAVES; ++octave) {
    const float finest = max(frequency.x, max(frequency.y, frequency.z));
    const float visible = 1 - smoothstep(0.25, 0.7, finest * pixel);
    sum += weight * visible * (2 * smooth_noise(p * frequency, seed + octave) - 1);
    total += weight;
    weight *= material.noise_decay;
    frequency *= 2.07;  // not 2, so that lattices do not line up
  }
  return clamp(1.5 * sum / total, -1, 1);
}

vec3 random_hue(float h) {
  const float value = 0.25 + 0.55 * fract(h * 57.3);
  return value * (0.55 + 0.45 * cos(6.2832 * (h + vec3(0, 0.33, 0.67))));
}

// How much of a pixel-wide filter at distance `d` from an edge lies on the positive side.
float covered(float d, float pixel) {
  return clamp(d / pixel + 0.5, 0, 1);
}

// Rows of dashes of random length, as text looks from afar: 1 on ink.
float text_lines(vec2 uv, float line_height, float pixel, uint seed) {
  const float row = floor(uv.y / line_height);
  const float letter = 0.45 * line_height;
  const int column = int(floor(uv.x / letter));
  const float word = random_at(ivec2(column / 7, int(row)), seed), mark = random_at(ivec2(column, int(row)), seed + 1);
  const float within = abs(uv.y / line_height - row - 0.5) * line_height;
  const float ink = covered(0.28 * line_height - within, pixel) * (mark < 0.78 && word < 0.85 ? 1.0 : 0.0);
  return mix(ink, 0.36, smoothstep(0.3, 0.9, pixel / letter));
}

vec3 poster(SceneMaterial material, vec2 uv, vec2 half_size, float pixel, uint seed) {
  const vec2 at = (uv + half_size) / (2 * half_size.y);  // 0 to 1 upwards
  const float p = pixel / (2 * half_size.y);
  vec3 colour = mix(material.first, material.second, smoothstep(0.2, 1, at.y + 0.2 * (random_at(ivec2(1), seed) - 0.5)));
  [[unroll]] for (int i = 0; i < 6; ++i) {
    const uint bits = mix_bits(seed * 0x9e3779b9u + i);
    const vec4 random = unpackUnorm4x8(bits);
    const vec2 middle = vec2(random.x * half_size.x / half_size.y, 0.35 + 0.6 * random.y);
    const float radius = 0.05 + 0.16 * random.z, kind = random.w;
    const vec2 off = at - middle;
    const float disc = radius - length(off), ring = min(disc, length(off) - 0.6 * radius);
    const float bar = min(0.25 * radius - abs(off.y), 2 * radius - abs(off.x));
    const float edge = kind < 0.4 ? disc : kind < 0.7 ? ring : bar;
    colour = mix(colour, 1.3 * random_hue(random.x + random.w), 0.9 * covered(edge, p));
  }
  const float ink = text_lines(at - vec2(0, 0.03), 0.045, p, seed) * covered(0.28 - at.y, p) * covered(at.y - 0.05, p);
  colour = mix(colour, vec3(0.03), ink);
  const vec2 to_rim = half_size - abs(uv);
  return mix(vec3(0.8), colour, covered(min(to_rim.x, to_rim.y) - 0.015, pixel));
}

vec3 window_view(SceneMaterial material, vec2 uv, float pixel, uint seed) {
  const vec3 p = vec3(uv * 1.3, 0.5);
  const float ridge = -0.15 + 0.25 * smooth_noise(vec3(1.7 * uv.x, 0.5, 0.5), seed) + 0.05 * smooth_noise(vec3(9 * uv.x, 0.5, 0.5), seed);
  const float cloud = smoothstep(0.45, 0.8, 0.6 * smooth_noise(p * vec3(1, 2.2, 1), seed + 1) + 0.4 * smooth_noise(p * vec3(3, 6, 1), seed + 2));
  const vec3 sky = mix(material.second, vec3(0.95), 0.8 * cloud);
  const vec3 hill = material.first * (0.6 + 0.8 * smooth_noise(p * 9, seed + 3));
  return mix(hill, sky, covered(uv.y - ridge, pixel));
}

vec3 screen(SceneMaterial material, vec2 uv, vec2 half_size, float pixel, uint seed) {
  const vec2 rim = half_size - abs(uv);
  const float inside = covered(min(rim.x, rim.y) - 0.02, pixel);
  const float indent = 0.02 + 0.06 * random_at(ivec2(int(floor(uv.y / 0.014)), 3), seed);
  const float ink = text_lines(uv, 0.014, pixel, seed) * covered(uv.x + half_size.x - indent, pixel);
  return mix(vec3(0.015), mix(material.first, material.second, ink), inside);
}

vec3 cells_and_noise(SceneMaterial material, vec2 uv, vec3 p, float pixel, uint seed) {
  const float noise = layered_noise(material, p, pixel, seed);
  const float row = floor(uv.y / material.cell.y);
  const float along = uv.x / material.cell.x + row * material.cell_shift;
  const float column = floor(along);
  const float own = random_at(ivec2(int(column), int(row)), seed + 17);
  const float smallest = min(material.cell.x, material.cell.y);
  const float visible = 1 - smoothstep(0.35, 1, pixel / smallest);
  const float blend = 0.5 + 0.5 * material.noise_contrast * noise + material.cell_contrast * (own - 0.5) * visible;
  vec3 colour = mix(material.first, material.second, clamp(blend, 0, 1));
  colour = mix(colour, random_hue(own) * (0.85 + 0.3 * blend), material.cell_hue * visible);
  const vec2 off = vec2(along - column, uv.y / material.cell.y - row);
  const vec2 to_joint = (0.5 - abs(off - 0.5)) * material.cell;
  const vec2 lines = covered(0.5 * material.joint - to_joint.x, pixel) * vec2(1, 0) +
                     covered(0.5 * material.joint - to_joint.y, pixel) * vec2(0, 1);
  const float line = mix(material.joint / smallest, max(lines.x, lines.y), visible) * min(1, material.joint / pixel);
  return colour * mix(1, JOINT_SHADE, material.joint > 0 ? line : 0);
}

// Texture coordinates on the face of the body that has the local normal `n`: v is vertical on upright faces.
vec2 face_coordinates(SceneShape shape, vec3 p, vec3 n, vec3 half_size) {
  const vec3 size = abs(n);
  if (shape.kind == SHAPE_BOX) return size.x > 0.5 ? p.yz : size.y > 0.5 ? p.xz : p.xy;
  if (shape.kind == SHAPE_CYLINDER && size.z > 0.5) return p.xy;
  return vec2(atan(p.y / half_size.y, p.x / half_size.x) * half_size.x, p.z);
}

// The unlit colour, linear RGB, of a body at a point of its surface. `pixel`: size of a pixel there, m.
vec3 surface_colour(SceneShape shape, SceneSurface surface, SceneMaterial material, vec3 point, vec3 normal, float pixel) {
  const vec3 p = to_unit(shape, point - surface.texture_origin) * surface.half_size;
  const vec3 n = to_unit(shape, normal) * surface.half_size;
  const vec2 uv = face_coordinates(shape, p, n, surface.half_size);
  const vec2 face = abs(n.x) > 0.5 ? surface.half_size.yz : abs(n.y) > 0.5 ? surface.half_size.xz : surface.half_size.xy;
  const uint seed = material.seed + 131 * surface.seed;
  if (material.pattern == PATTERN_POSTER) return poster(material, uv, face, pixel, seed);
  if (material.pattern == PATTERN_VIEW) return window_view(material, uv, pixel, seed);
  if (material.pattern == PATTERN_SCREEN) return screen(material, uv, face, pixel, seed);
  return cells_and_noise(material, uv, p, pixel, seed);
}

#endif
