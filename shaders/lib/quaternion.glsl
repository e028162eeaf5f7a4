// Unit quaternions w, x, y, z and their rotation matrices.

/// Rotation matrix of a unit quaternion q = (w, x, y, z).
mat3 rotation_of(vec4 q) {
  const float w = q.x, x = q.y, y = q.z, z = q.w;
  return mat3(1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y),   // first column
              2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x),   //
              2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y));
}

/// dL/dq (not yet through the normalisation) from G = dL/d(rotation_of(q)).
vec4 rotation_backward(vec4 q, mat3 G) {
  const float w = q.x, x = q.y, y = q.z, z = q.w;
  // G[c][r] is dL/dR_rc.
  const vec3 antisymmetric = vec3(G[1][2] - G[2][1], G[2][0] - G[0][2], G[0][1] - G[1][0]);
  const vec3 symmetric = vec3(G[1][2] + G[2][1], G[2][0] + G[0][2], G[0][1] + G[1][0]);
  return vec4(2 * dot(vec3(x, y, z), antisymmetric),
              2 * (w * antisymmetric.x + y * symmetric.z + z * symmetric.y - 2 * x * (G[1][1] + G[2][2])),
              2 * (w * antisymmetric.y + x * symmetric.z + z * symmetric.x - 2 * y * (G[0][0] + G[2][2])),
              2 * (w * antisymmetric.z + x * symmetric.y + y * symmetric.x - 2 * z * (G[0][0] + G[1][1])));
}

/// The quaternion of turning by b and then by a.
vec4 quaternion_product(vec4 a, vec4 b) {
  return vec4(a.x * b.x - dot(a.yzw, b.yzw), a.x * b.yzw + b.x * a.yzw + cross(a.yzw, b.yzw));
}
