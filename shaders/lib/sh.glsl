// Spherical harmonics of degree 0 to 3, with the constants and signs of the standard 3DGS files.
// Needs the buffer `sh` (vec3 per coefficient) and the constant SH_DEGREE.

const float SH0 = 0.28209479177387814;
const float SH1 = 0.4886025119029199;
const float SH2[5] = float[](1.0925484305920792, -1.0925484305920792, 0.31539156525252005, -1.0925484305920792,
                             0.5462742152960396);
const float SH3[7] = float[](-0.5900435899266435, 2.890611442640554, -0.4570457994644658, 0.3731763325901154,
                             -0.4570457994644658, 1.445305721320277, -0.5900435899266435);

const uint SH_COUNT = (SH_DEGREE + 1) * (SH_DEGREE + 1);

/// Basis functions at the unit direction d.
void sh_basis(vec3 d, out float basis[16]) {
  const float x = d.x, y = d.y, z = d.z, xx = x * x, yy = y * y, zz = z * z;
  basis[0] = SH0;
  basis[1] = -SH1 * y;
  basis[2] = SH1 * z;
  basis[3] = -SH1 * x;
  basis[4] = SH2[0] * x * y;
  basis[5] = SH2[1] * y * z;
  basis[6] = SH2[2] * (2 * zz - xx - yy);
  basis[7] = SH2[3] * x * z;
  basis[8] = SH2[4] * (xx - yy);
  basis[9] = SH3[0] * y * (3 * xx - yy);
  basis[10] = SH3[1] * x * y * z;
  basis[11] = SH3[2] * y * (4 * zz - xx - yy);
  basis[12] = SH3[3] * z * (2 * zz - 3 * xx - 3 * yy);
  basis[13] = SH3[4] * x * (4 * zz - xx - yy);
  basis[14] = SH3[5] * z * (xx - yy);
  basis[15] = SH3[6] * x * (xx - 3 * yy);
}

/// Gradient of every basis function with respect to d, as if d were free (not of unit length).
void sh_basis_gradient(vec3 d, out vec3 g[16]) {
  const float x = d.x, y = d.y, z = d.z, xx = x * x, yy = y * y, zz = z * z;
  g[0] = vec3(0);
  g[1] = vec3(0, -SH1, 0);
  g[2] = vec3(0, 0, SH1);
  g[3] = vec3(-SH1, 0, 0);
  g[4] = SH2[0] * vec3(y, x, 0);
  g[5] = SH2[1] * vec3(0, z, y);
  g[6] = SH2[2] * vec3(-2 * x, -2 * y, 4 * z);
  g[7] = SH2[3] * vec3(z, 0, x);
  g[8] = SH2[4] * vec3(2 * x, -2 * y, 0);
  g[9] = SH3[0] * vec3(6 * x * y, 3 * xx - 3 * yy, 0);
  g[10] = SH3[1] * vec3(y * z, x * z, x * y);
  g[11] = SH3[2] * vec3(-2 * x * y, 4 * zz - xx - 3 * yy, 8 * y * z);
  g[12] = SH3[3] * vec3(-6 * x * z, -6 * y * z, 6 * zz - 3 * xx - 3 * yy);
  g[13] = SH3[4] * vec3(4 * zz - 3 * xx - yy, -2 * x * y, 8 * x * z);
  g[14] = SH3[5] * vec3(2 * x * z, -2 * y * z, xx - yy);
  g[15] = SH3[6] * vec3(3 * xx - 3 * yy, -6 * x * y, 0);
}

/// 0.5 + SH of Gaussian i seen along the unit direction d, before the clamp at 0.
vec3 sh_colour(uint i, vec3 d) {
  vec3 colour = vec3(0.5);
  if (SH_DEGREE == 0) return colour + SH0 * sh[i];
  float basis[16];
  sh_basis(d, basis);
  [[unroll]] for (uint k = 0; k < SH_COUNT; ++k) colour += basis[k] * sh[i * SH_COUNT + k];
  return colour;
}
