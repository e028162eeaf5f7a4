// Rays against the convex bodies of a synthetic scene.
#ifndef SUREFIELD_LIB_SCENE_SHAPES_GLSL
#define SUREFIELD_LIB_SCENE_SHAPES_GLSL

const float BEYOND = 1e30;

vec3 to_unit(SceneShape shape, vec3 v) {
  return vec3(dot(shape.row0, v), dot(shape.row1, v), dot(shape.row2, v));
}

// Where the line o + t d, in unit coordinates, is inside the cube from -1 to 1: t from x to y; x > y where it misses.
vec2 crossing_cube(vec3 o, vec3 d) {
  const vec3 step = 1 / mix(d, vec3(1e-20), lessThan(abs(d), vec3(1e-20)));
  const vec3 middle = -o * step, reach = abs(step);
  const vec3 low = middle - reach, high = middle + reach;
  return vec2(max(low.x, max(low.y, low.z)), min(high.x, min(high.y, high.z)));
}

// The same for the unit ball, or for the unit cylinder.
vec2 crossing_round(vec3 o, vec3 d, bool cylinder) {
  // From the point of the line that is nearest to the centre or the axis: thin bodies far away would lose all digits in
  // the textbook formula.
  const vec3 weight = vec3(1, 1, cylinder ? 0 : 1);
  const vec3 wo = weight * o, wd = weight * d;
  const float inverse_square = 1 / max(dot(wd, wd), 1e-30);
  const float middle = -dot(wo, wd) * inverse_square;
  const vec3 nearest = wo + middle * wd;
  const float room = 1 - dot(nearest, nearest);
  const float half_chord = sqrt(max(room, 0) * inverse_square);
  const float step = 1 / (abs(d.z) < 1e-20 ? 1e-20 : d.z);
  const float cap = cylinder ? abs(step) : BEYOND, cap_middle = cylinder ? -o.z * step : 0;
  return vec2(room > 0 ? max(middle - half_chord, cap_middle - cap) : BEYOND, min(middle + half_chord, cap_middle + cap));
}

// Where the line origin + t * direction is inside the body.
vec2 crossing(SceneShape shape, vec3 origin, vec3 direction) {
  const vec3 o = to_unit(shape, origin - shape.centre), d = to_unit(shape, direction);
  const vec2 cube = crossing_cube(o, d), round = crossing_round(o, d, shape.kind == SHAPE_CYLINDER);
  return shape.kind == SHAPE_BOX ? cube : round;
}

// The outward normal in the world at a point of the surface.
vec3 outward_normal(SceneShape shape, vec3 point) {
  const vec3 p = to_unit(shape, point - shape.centre);
  const vec3 size = abs(p);
  vec3 n = p;
  if (shape.kind == SHAPE_CYLINDER) n = size.z > length(p.xy) ? vec3(0, 0, p.z) : vec3(p.xy, 0);
  if (shape.kind == SHAPE_BOX) {
    n = size.x >= size.y && size.x >= size.z ? vec3(p.x, 0, 0) : size.y >= size.z ? vec3(0, p.y, 0) : vec3(0, 0, p.z);
  }
  return normalize(n.x * shape.row0 + n.y * shape.row1 + n.z * shape.row2);
}

// Whether the body can be met by a ray that starts within `radius` of the origin and leaves it at an angle to the unit
// vector `axis` of at most that of the tangent `spread`. May be true where it cannot.
bool touches_cone(SceneShape shape, vec3 origin, float radius, vec3 axis, float spread) {
  const vec3 scale = vec3(length(shape.row0), length(shape.row1), length(shape.row2));
  const float furthest = length(shape.centre - origin) + length(1 / scale);
  const vec3 reach = 1 + (radius + spread * furthest) * scale;
  const vec3 o = to_unit(shape, origin - shape.centre);
  vec3 d = to_unit(shape, axis);
  d = mix(d, vec3(1e-20), lessThan(abs(d), vec3(1e-20)));
  const vec3 a = (-reach - o) / d, b = (reach - o) / d;
  const vec3 low = min(a, b), high = max(a, b);
  const float exit = min(high.x, min(high.y, high.z));
  return exit >= 0 && max(low.x, max(low.y, low.z)) <= exit;
}

#endif
