// The EWA projection of a Gaussian (paper eq. 1 and 2; docs/method.md, "Forward"). Needs splat_types.h, quaternion.glsl.

const float NEAR_PLANE = 0.01;      // metres
const float BLUR = 0.3;             // pixels^2 added to the 2D covariance, of the pixels that the Gaussian was seen with
const float TANGENT_MARGIN = 1.3;   // x/z is clamped to this times the tangent of the image border
const float ALPHA_MIN = 1.0 / 255.0;
const float ALPHA_MAX = 0.99;
const float TRANSMITTANCE_MIN = 1e-4;

mat3 camera_rotation(CameraState c) {
  return transpose(mat3(c.rotation0, c.rotation1, c.rotation2));
}

/// World to camera.
vec3 to_camera(CameraState c, vec3 x) {
  return vec3(dot(c.rotation0, x), dot(c.rotation1, x), dot(c.rotation2, x)) + c.translation;
}

/// The perspective Jacobian J = [fx/z 0 -fx tx/z; 0 fy/z -fy ty/z], tx and ty the clamped x/z and y/z.
struct Perspective {
  vec2 focal_over_z;   // J11, J22
  vec2 slope;          // J13, J23
  vec2 tangent;        // tx, ty
  bvec2 clamped;
};

Perspective perspective_of(CameraState c, vec3 x_c) {
  const vec2 focal = vec2(c.fx, c.fy);
  const vec2 low = TANGENT_MARGIN * (vec2(-0.5) - vec2(c.cx, c.cy)) / focal;
  const vec2 high = TANGENT_MARGIN * (vec2(c.width, c.height) - 0.5 - vec2(c.cx, c.cy)) / focal;
  const vec2 tangent = x_c.xy / x_c.z;
  Perspective p;
  p.tangent = clamp(tangent, min(low, high), max(low, high));
  p.clamped = notEqual(p.tangent, tangent);
  p.focal_over_z = focal / x_c.z;
  p.slope = -p.focal_over_z * p.tangent;
  return p;
}

/// V = R Rq S: the columns are the Gaussian's axes in the camera frame, scaled; Sigma_c = V V^T.
mat3 camera_axes(CameraState c, vec4 rotation, vec3 log_scale) {
  mat3 axes = camera_rotation(c) * rotation_of(normalize(rotation));
  axes[0] *= exp(log_scale.x);
  axes[1] *= exp(log_scale.y);
  axes[2] *= exp(log_scale.z);
  return axes;
}

/// The pixels^2 that are added to the 2D covariance at depth z, and their derivative by z: where pixels are finer in the world
/// than the finest that the Gaussian was seen with, as many of those, so that what covers a surface there covers it here.
vec2 blur_of(CameraState c, float sampling, float z) {
  const float finer = sampling * sampling * c.fx * c.fy / (z * z);
  return finer > 1 ? BLUR * finer * vec2(1, -2 / z) : vec2(BLUR, 0);
}

/// The rows of A = J V (2 x 3); Sigma_2 = A A^T + blur I.
void image_axes(Perspective p, mat3 V, out vec3 row0, out vec3 row1) {
  const mat3 rows = transpose(V);
  row0 = p.focal_over_z.x * rows[0] + p.slope.x * rows[2];
  row1 = p.focal_over_z.y * rows[1] + p.slope.y * rows[2];
}

/// The 2D covariance (xx, xy, yy).
vec3 covariance_2d(vec3 row0, vec3 row1, float blur) {
  return vec3(dot(row0, row0) + blur, dot(row0, row1), dot(row1, row1) + blur);
}

/// The slope of the depth over the footprint: the mean of z given u and v, where (u, v, z) is distributed as the projected
/// Gaussian. It is Cov(z, uv) Cov(uv)^-1 with Cov(z, uv) = A V_z, V_z the third row of V.
vec2 depth_slope_of(vec3 row0, vec3 row1, vec3 row2, vec3 inverse) {
  const vec2 c = vec2(dot(row0, row2), dot(row1, row2));
  return vec2(inverse.x * c.x + inverse.y * c.y, inverse.y * c.x + inverse.z * c.y);
}

vec3 inverse_2d(vec3 m) {
  return vec3(m.z, -m.y, m.x) / (m.x * m.z - m.y * m.y);
}
