// The chain rule through the projection (docs/method.md, "Backward"). Needs splat_types.h, projection.glsl, sh.glsl and
// the constants SH_DEGREE, FULL_POSE_GRADIENT and PLANE_DEPTH.

/// dL/d(mean in the world), dL/dM with M = Rq S (world), dL/dpose.
struct ProjectionGradient {
  vec3 mean;
  mat3 axes;            // dL/dV, in the camera frame
  PoseGradient pose;
};

/// dL/dSigma_2 (xx, xy, yy; xy stands for both) = -K (dL/dK) K with dL/dK = -1/2 sum g d d^T.
vec3 covariance_gradient(vec3 conic, vec3 second) {
  const mat2 K = mat2(conic.x, conic.y, conic.y, conic.z);
  const mat2 moments = mat2(second.x, second.y, second.y, second.z);
  const mat2 G = 0.5 * K * moments * K;
  return vec3(G[0][0], G[0][1], G[1][1]);
}

/// dL/d(projected centre): through the footprint, and through the plane of the depth, which moves with it.
vec2 centre_gradient(Splat s, SplatGradient g) {
  return vec2(s.conic.x * g.first.x + s.conic.y * g.first.y, s.conic.y * g.first.x + s.conic.z * g.first.y) -
         g.depth * s.slope;
}

/// Gradient with respect to the unnormalised viewing direction; fills the SH coefficients' gradients where asked.
vec3 direction_gradient(uint i, vec3 direction, vec3 g_colour) {
  if (SH_DEGREE == 0) return vec3(0);
  const float inverse_length = inversesqrt(dot(direction, direction));
  const vec3 d = direction * inverse_length;
  vec3 basis_gradient[16];
  sh_basis_gradient(d, basis_gradient);
  vec3 g = vec3(0);
  [[unroll]] for (uint k = 1; k < SH_COUNT; ++k) g += dot(g_colour, sh[i * SH_COUNT + k]) * basis_gradient[k];
  return (g - d * dot(d, g)) * inverse_length;
}

/// `g_direction`: direction_gradient() of this Gaussian.
ProjectionGradient project_backward(CameraState c, vec3 mean, float sampling, mat3 V, Splat s, SplatGradient g,
                                    vec3 g_direction) {
  const vec3 x_c = to_camera(c, mean);
  const Perspective p = perspective_of(c, x_c);
  const float inverse_z = 1 / x_c.z;

  // Through the centre and the depth.
  const vec2 g_image = p.focal_over_z * centre_gradient(s, g);
  vec3 g_camera = vec3(g_image, -dot(g_image, x_c.xy) * inverse_z + g.depth);
  const vec3 light = g_camera;

  // Through the covariance: Sigma_2 = A A^T + blur I, A = J V.
  vec3 row0, row1;
  image_axes(p, V, row0, row1);
  vec3 G = covariance_gradient(s.conic, g.second);
  const mat3 rows = transpose(V);
  // Through the depth's slope q = K c, c = A V_z: with h = dL/dc = K dL/dq, dL/dSigma_2 = -(h q^T + q h^T) / 2.
  vec2 h = vec2(0);
  if (PLANE_DEPTH == 1)
    h = vec2(s.conic.x * g.depth_first.x + s.conic.y * g.depth_first.y,
             s.conic.y * g.depth_first.x + s.conic.z * g.depth_first.y);
  G -= vec3(h.x * s.slope.x, 0.5 * (h.x * s.slope.y + h.y * s.slope.x), h.y * s.slope.y);
  const vec3 g_row0 = 2 * (G.x * row0 + G.y * row1) + h.x * rows[2];
  const vec3 g_row1 = 2 * (G.y * row0 + G.z * row1) + h.y * rows[2];
  const vec3 g_depth_row = h.x * row0 + h.y * row1;   // dL/dV_z, but for the part through J
  const vec2 g_focal = vec2(dot(g_row0, rows[0]), dot(g_row1, rows[1]));   // dL/dJ11, dL/dJ22
  const vec2 g_slope = vec2(dot(g_row0, rows[2]), dot(g_row1, rows[2]));   // dL/dJ13, dL/dJ23
  // J11 = f/z; J13 = -f t/z with t = x/z, or t constant where it is clamped.
  const vec2 slope_by_z = mix(-2 * p.slope, -p.slope, vec2(p.clamped)) * inverse_z;
  const vec2 slope_by_x = mix(-p.focal_over_z * inverse_z, vec2(0), vec2(p.clamped));
  g_camera.xy += g_slope * slope_by_x;
  g_camera.z += dot(g_slope, slope_by_z) - dot(g_focal, p.focal_over_z) * inverse_z;
  g_camera.z += (G.x + G.z) * blur_of(c, sampling, x_c.z).y;

  ProjectionGradient result;
  result.axes = transpose(mat3(p.focal_over_z.x * g_row0, p.focal_over_z.y * g_row1,
                               p.slope.x * g_row0 + p.slope.y * g_row1 + g_depth_row));
  result.mean = transpose(camera_rotation(c)) * g_camera + g_direction;
  const vec3 rotated = x_c - c.translation;   // R x_w
  if (FULL_POSE_GRADIENT == 1) {
    const vec3 g_view = camera_rotation(c) * g_direction;
    result.pose.translation = g_camera + g_view;
    result.pose.rotation = cross(rotated, g_camera) + cross(V[0], result.axes[0]) + cross(V[1], result.axes[1]) +
                           cross(V[2], result.axes[2]) + cross(g_view, c.translation);
  } else {
    result.pose.translation = light;
    result.pose.rotation = cross(rotated, light);
  }
  return result;
}
