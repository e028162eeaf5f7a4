// Going backward through the blending of a pixel (docs/method.md, "Backward"), front to back like the forward pass. With
// s_i = dL/dw_i the value of Gaussian i's weight w_i = alpha_i T_i, and S = sum w_i s_i known from the rendered images,
//   alpha_i dL/dalpha_i = w_i s_i - (S - sum_{j<=i} w_j s_j) w_i / T_{i+1},
// which is the suffix recursion without a second traversal. Needs splat_types.h, projection.glsl and tile_pixels.glsl, the
// buffers sensor_depth and pixel_upstream, and the constant WITH_GEOMETRY: whether there are gradients of median depth and
// uncertainty.

/// s_i for a Gaussian of this colour and depth.
float weight_value(PixelUpstream p, float sensor, vec3 colour, float depth) {
  const float value = dot(p.colour, colour) + p.depth * depth + p.constant;
  if (WITH_GEOMETRY == 0) return value;
  const float off = depth - sensor;
  return value + p.uncertainty * off * off;
}

/// dL/dz of a Gaussian of this depth at the pixel with this weight. The median belongs to the one that takes the transmittance from
/// `before` below one half.
float depth_gradient(PixelUpstream p, float sensor, float weight, float depth, float before, float after) {
  if (WITH_GEOMETRY == 0) return weight * p.depth;
  return weight * (p.depth + 2 * p.uncertainty * (depth - sensor)) + (before >= 0.5 && after < 0.5 ? p.median : 0.0);
}

// The lane's pixels (lib/tile_pixels.glsl).
PixelUpstream upstream[PIXELS];
float sensor[PIXELS];   // WITH_GEOMETRY
float transmittance[PIXELS], behind[PIXELS];

void load_pixels(CameraState c) {
  [[unroll]] for (uint k = 0; k < PIXELS; ++k) {
    const uvec2 pixel = lane_pixel(k % COLUMNS, k / COLUMNS);
    const bool inside = pixel.x < c.width && pixel.y < c.height;
    const uint at = inside ? pixel.y * c.width + pixel.x : 0;
    transmittance[k] = inside ? 1.0 : 0.0;
    upstream[k] = pixel_upstream[at];
    behind[k] = upstream[k].total;
    if (WITH_GEOMETRY == 1) sensor[k] = sensor_depth[at];
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
SplatGradient visit_batch(Stamp my) {
  const vec2 origin = vec2(lane_origin());
  SplatGradient total = SplatGradient(0.0, vec2(0), vec3(0), vec3(0), 0.0, vec2(0));
  for (uint group = 0; group < LANES; group += GROUP) {
    float g0[GROUP], gx[GROUP], gy[GROUP], gxx[GROUP], gxy[GROUP], gyy[GROUP];
    float red[GROUP], green[GROUP], blue[GROUP], gz[GROUP], gzx[GROUP], gzy[GROUP];
    [[unroll]] for (uint member = 0; member < GROUP; ++member) {
      const Stamp stamp = stamp_from(my, group + member);
      const vec2 d = origin - stamp.centre;
      g0[member] = gx[member] = gy[member] = gxx[member] = gxy[member] = gyy[member] = 0;
      gz[member] = gzx[member] = gzy[member] = 0;
      vec3 g_colour = vec3(0);
      [[unroll]] for (uint column = 0; column < COLUMNS; ++column) {
        const float dx = d.x + float(column * LANES);
        const float along = stamp.form.x * dx * dx + stamp.log_opacity, across = stamp.form.y * dx;
        const float column_depth = stamp.depth + stamp.slope.x * dx;
        float sum = 0, sum_y = 0, sum_yy = 0, sum_z = 0, sum_zy = 0;
        [[unroll]] for (uint row = 0; row < ROWS; ++row) {
          const uint k = row * COLUMNS + column;
          const float dy = d.y + float(row * ROW_STEP);
          const float before = transmittance[k];
          const Layer l = layer_of(along + dy * (across + stamp.form.z * dy), before);
          transmittance[k] = l.stops ? 0.0 : l.left;
          const float z = column_depth + stamp.slope.y * dy;
          const float value = weight_value(upstream[k], sensor[k], stamp.colour, z);
          behind[k] -= l.weight * value;
          // dL/dexponent = alpha dL/dalpha; none through the clamp of alpha.
          const float slope = l.weight * (value - behind[k] / max(l.left, TRANSMITTANCE_MIN));
          const float g = l.raw > ALPHA_MAX ? 0.0 : slope;
          sum += g;
          sum_y += g * dy;
          sum_yy += g * dy * dy;
          g_colour += l.weight * upstream[k].colour;
          const float g_z = depth_gradient(upstream[k], sensor[k], l.weight, z, before, transmittance[k]);
          sum_z += g_z;
          sum_zy += g_z * dy;
        }
        g0[member] += sum;
        gx[member] += sum * dx;
        gy[member] += sum_y;
        gxx[member] += sum * dx * dx;
        gxy[member] += sum_y * dx;
        gyy[member] += sum_yy;
        gz[member] += sum_z;
        gzx[member] += sum_z * dx;
        gzy[member] += sum_zy;
      }
      red[member] = g_colour.r;
      green[member] = g_colour.g;
      blue[member] = g_colour.b;
    }
    const SplatGradient reduced =
        SplatGradient(reduce_group(g0), vec2(reduce_group(gx), reduce_group(gy)),
                      vec3(reduce_group(gxx), reduce_group(gxy), reduce_group(gyy)),
                      vec3(reduce_group(red), reduce_group(green), reduce_group(blue)),
                      reduce_group(gz), vec2(reduce_group(gzx), reduce_group(gzy)));
    if (gl_SubgroupInvocationID / GROUP == group / GROUP) total = reduced;
  }
  return total;
}
