// Steps of a pose in {so(3)|T}: R <- Exp(phi) R, t <- t + tau. Needs loss_types.h and adam.glsl.

/// Exp of so(3), Rodrigues' formula.
mat3 exp_so3(vec3 phi) {
  const float angle2 = dot(phi, phi), angle = sqrt(angle2);
  const float a = angle > 1e-4 ? sin(angle) / angle : 1 - angle2 / 6;
  const float b = angle > 1e-4 ? (1 - cos(angle)) / angle2 : 0.5 - angle2 / 24;
  const mat3 K = mat3(0, phi.z, -phi.y, -phi.z, 0, phi.x, phi.y, -phi.x, 0);
  return mat3(1) + a * K + b * K * K;
}

/// Moves a camera by (phi, tau); R is made orthonormal again, since steps add up.
void move_camera(inout CameraState c, vec3 phi, vec3 tau) {
  const mat3 R = exp_so3(phi) * transpose(mat3(c.rotation0, c.rotation1, c.rotation2));
  const mat3 rows = transpose(R);
  c.rotation0 = normalize(rows[0]);
  c.rotation1 = normalize(rows[1] - dot(rows[1], c.rotation0) * c.rotation0);
  c.rotation2 = cross(c.rotation0, c.rotation1);
  c.translation += tau;
}

/// One step of Adam down the gradient; returns the largest of the angle and the distance moved.
float adam_move(inout CameraState c, inout PoseAdam adam, PoseGradient g, float rate_rotation,
                float rate_translation) {
  adam.steps += 1;
  const vec2 corrections = adam_corrections(adam.steps);
  const vec3 phi =
      -rate_rotation * adam_step(g.rotation, adam.first_moment.rotation, adam.second_moment.rotation, corrections);
  const vec3 tau = -rate_translation * adam_step(g.translation, adam.first_moment.translation,
                                                 adam.second_moment.translation, corrections);
  move_camera(c, phi, tau);
  return max(length(phi), length(tau));
}

bool is_finite(PoseGradient g) {
  const float probe = dot(g.rotation, g.rotation) + dot(g.translation, g.translation);
  return !isnan(probe) && !isinf(probe);
}
