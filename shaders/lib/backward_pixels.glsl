// Going backward through the blending of a pixel (docs/method.md, "Backward"), front to back like the forward pass. With
// s_i = dL/dw_i the value of Gaussian i's weight w_i = alpha_i T_i, and S = sum w_i s_i known from the rendered images,
//   dL/dalpha_i = T_i s_i - (S - sum_{j<=i} w_j s_j) / (1 - alpha_i),
// which is the suffix recursion without a second traversal. Needs splat_types.h, projection.glsl and tile_pixels.glsl, and
// the buffers colour_opacity, geometry, sensor_depth and pixel_gradients.

/// What stays the same at a pixel while its Gaussians are visited.
struct PixelUpstream {
  vec3 colour;        // dL/dI
  float constant;     // the part of s_i that does not depend on the Gaussian
  float depth;        // dL/dD_alpha, with the part through the normalised depth
  float median;
  float uncertainty;
  float sensor;
  float total;        // S
};

PixelUpstream upstream_of(uint at, vec3 background) {
  const PixelGradient g = pixel_gradients[at];
  const vec4 image = colour_opacity[at];
  const vec4 geo = geometry[at];
  PixelUpstream p;
  p.sensor = sensor_depth[at];
  p.colour = g.colour;
  p.median = g.depth_median;
  p.uncertainty = p.sensor > 0 ? g.uncertainty : 0;
  const float normalised = image.w > 0 ? g.depth_normalised / image.w : 0;
  p.depth = g.depth + normalised;
  p.constant = g.opacity - dot(g.colour, background) -
               (image.w > 0 ? normalised * geo.x / image.w : 0);
  p.total = dot(p.colour, image.rgb - (1 - image.w) * background) + p.depth * geo.x + p.constant * image.w +
            p.uncertainty * geo.z;
  return p;
}

/// s_i for a Gaussian of this colour and depth.
float weight_value(PixelUpstream p, vec3 colour, float depth) {
  const float off = depth - p.sensor;
  return dot(p.colour, colour) + p.depth * depth + p.constant + p.uncertainty * off * off;
}

/// One (pixel, Gaussian): advances the pixel and gives the weight and dL/dexponent.
struct Visit {
  float weight;
  float exponent;     // dL/dexponent; 0 where alpha is clamped, skipped or behind the stop
  bool is_median;
};

Visit visit(float exponent, float opacity, float value, float total, inout float transmittance, inout float passed) {
  const float raw = opacity * exp(exponent);
  float alpha = min(ALPHA_MAX, raw);
  alpha = alpha < ALPHA_MIN ? 0.0 : alpha;
  const float before = transmittance;
  const float after = before - alpha * before;
  const bool stops = after < TRANSMITTANCE_MIN;
  Visit v;
  v.weight = stops ? 0.0 : alpha * before;
  v.is_median = before >= 0.5 && after < 0.5;
  passed += v.weight * value;
  const float dalpha = before * value - (total - passed) / (1 - alpha);
  v.exponent = stops || raw > ALPHA_MAX ? 0.0 : alpha * dalpha;
  transmittance = stops ? 0.0 : after;
  return v;
}

// The lane's pixels (lib/tile_pixels.glsl).
PixelUpstream upstream[PIXELS];
float transmittance[PIXELS], passed[PIXELS];

void load_pixels(CameraState c, vec3 background) {
  [[unroll]] for (uint k = 0; k < PIXELS; ++k) {
    const uvec2 pixel = lane_pixel(k % COLUMNS, k / COLUMNS);
    const bool inside = pixel.x < c.width && pixel.y < c.height;
    transmittance[k] = inside ? 1.0 : 0.0;
    passed[k] = 0;
    upstream[k] = upstream_of(inside ? pixel.y * c.width + pixel.x : 0, background);
  }
}

/// Whether any pixel of the tile still lets light through.
bool tile_is_open() {
  float open = 0;
  [[unroll]] for (uint k = 0; k < PIXELS; ++k) open = max(open, transmittance[k]);
  return subgroupAny(open > 0);
}

/// Visits the batch of Gaussians that the lanes have loaded (`my` each) at all pixels of the tile; gives every lane the
/// sums of its own Gaussian. What a caller does not use of them costs nothing.
SplatGradient visit_batch(Splat my) {
  const vec2 origin = vec2(lane_origin());
  SplatGradient total = SplatGradient(0.0, vec2(0), vec3(0), vec3(0), 0.0);
  for (uint group = 0; group < GROUPS; ++group) {
    float g0[GROUP], gx[GROUP], gy[GROUP], gxx[GROUP], gxy[GROUP], gyy[GROUP];
    float red[GROUP], green[GROUP], blue[GROUP], depth[GROUP];
    [[unroll]] for (uint member = 0; member < GROUP; ++member) {
      const uint lane = lane_of(group, member);
      const vec2 d = origin - subgroupShuffle(my.centre, lane);
      const vec3 conic = subgroupShuffle(my.conic, lane);
      const float splat_opacity = subgroupShuffle(my.opacity, lane);
      const vec3 splat_colour = subgroupShuffle(my.colour, lane);
      const float splat_depth = subgroupShuffle(my.depth, lane);
      g0[member] = gx[member] = gy[member] = gxx[member] = gxy[member] = gyy[member] = depth[member] = 0;
      vec3 g_colour = vec3(0);
      [[unroll]] for (uint column = 0; column < COLUMNS; ++column) {
        const float dx = d.x + float(column * LANES);
        const float xx = -0.5 * conic.x * dx * dx, xy = -conic.y * dx;
        float sum = 0, sum_y = 0, sum_yy = 0;
        [[unroll]] for (uint row = 0; row < ROWS; ++row) {
          const uint k = row * COLUMNS + column;
          const float dy = d.y + float(row * ROW_STEP);
          const float value = weight_value(upstream[k], splat_colour, splat_depth);
          const Visit v = visit(xx + dy * (xy - 0.5 * conic.z * dy), splat_opacity, value, upstream[k].total,
                                transmittance[k], passed[k]);
          sum += v.exponent;
          sum_y += v.exponent * dy;
          sum_yy += v.exponent * dy * dy;
          g_colour += v.weight * upstream[k].colour;
          depth[member] += v.weight * (upstream[k].depth +
                                       2 * upstream[k].uncertainty * (splat_depth - upstream[k].sensor)) +
                           (v.is_median ? upstream[k].median : 0.0);
        }
        g0[member] += sum;
        gx[member] += sum * dx;
        gy[member] += sum_y;
        gxx[member] += sum * dx * dx;
        gxy[member] += sum_y * dx;
        gyy[member] += sum_yy;
      }
      red[member] = g_colour.r;
      green[member] = g_colour.g;
      blue[member] = g_colour.b;
    }
    const SplatGradient reduced =
        SplatGradient(reduce_group(g0), vec2(reduce_group(gx), reduce_group(gy)),
                      vec3(reduce_group(gxx), reduce_group(gxy), reduce_group(gyy)),
                      vec3(reduce_group(red), reduce_group(green), reduce_group(blue)), reduce_group(depth));
    if (gl_SubgroupInvocationID % GROUPS == group) total = reduced;
  }
  return total;
}
