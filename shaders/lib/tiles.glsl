// Which tiles a footprint touches, exactly. Needs splat_types.h, projection.glsl and the constants TILE_W, TILE_H.
// `precise` everywhere: two passes compute this and must agree to the last bit, whatever a compiler likes to fuse.

/// The ellipse d^T conic d <= limit around `centre`, where alpha falls below ALPHA_MIN; widened by a hair so that no pixel
/// is lost to rounding. A negative limit: never visible.
struct Footprint {
  vec2 centre;
  vec3 conic;
  float limit;
  vec2 extent;   // half sizes of the bounding box
  uvec2 rows;    // tile rows [x, y)
};

uvec2 tiles_of(CameraState c) {
  return uvec2((c.width + TILE_W - 1) / TILE_W, (c.height + TILE_H - 1) / TILE_H);
}

Footprint footprint_of(CameraState c, Splat s) {
  Footprint f;
  f.centre = s.centre;
  f.conic = s.conic;
  precise const float limit = 2 * log(s.opacity / ALPHA_MIN) * 1.0001 + 1e-4;
  f.limit = limit;
  precise const float determinant = s.conic.x * s.conic.z - s.conic.y * s.conic.y;
  precise const vec2 extent = sqrt(max(limit, 0) * vec2(s.conic.z, s.conic.x) / determinant) * 1.0001 + 1e-3;
  f.extent = extent;
  const float last_row = float(c.height) - 1;
  precise const float top = max(ceil(s.centre.y - extent.y), 0);
  precise const float bottom = min(floor(s.centre.y + extent.y), last_row);
  precise const float left = s.centre.x - extent.x, right = s.centre.x + extent.x;
  const bool on_image = limit > 0 && top <= bottom && right >= 0 && left <= float(c.width) - 1;
  f.rows = on_image ? uvec2(uint(top) / TILE_H, uint(bottom) / TILE_H + 1) : uvec2(0);
  return f;
}

/// Tiles [x, y) of tile row `row` that the ellipse touches. The part of the ellipse in the row's band of pixel centres
/// is convex, so its extent in x is that of the ellipse's own left- or rightmost point if it lies in the band, else
/// that on the band's nearer edge.
uvec2 touched_tiles(Footprint f, CameraState c, uint row) {
  const float a = f.conic.x, b = f.conic.y, d = f.conic.z;
  precise const float band_top = float(row * TILE_H) - f.centre.y;
  precise const float band_bottom = min(float(row * TILE_H + TILE_H), float(c.height)) - 1 - f.centre.y;
  // The rightmost point has y = -b/d * x with x the half extent; the leftmost is its mirror image.
  precise const float y_right = clamp(-b / d * f.extent.x, band_top, band_bottom);
  precise const float y_left = clamp(b / d * f.extent.x, band_top, band_bottom);
  precise const float reach_right = b * b * y_right * y_right - a * (d * y_right * y_right - f.limit);
  precise const float reach_left = b * b * y_left * y_left - a * (d * y_left * y_left - f.limit);
  if (reach_right < 0 || reach_left < 0) return uvec2(0);
  precise const float right = f.centre.x + (-b * y_right + sqrt(reach_right)) / a + 1e-3;
  precise const float left = f.centre.x + (-b * y_left - sqrt(reach_left)) / a - 1e-3;
  const float first = max(ceil(left), 0), last = min(floor(right), float(c.width) - 1);
  return first <= last ? uvec2(uint(first) / TILE_W, uint(last) / TILE_W + 1) : uvec2(0);
}
