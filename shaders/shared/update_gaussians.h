// One step of Adam on every visible Gaussian.
#include "splat_types.h"

#define PASS update_gaussians
#define PASS_PARAMS(P)                                                                                    \
  P(float, rate_mean) P(float, rate_log_scale) P(float, rate_rotation) P(float, rate_opacity)
#define PASS_BINDINGS(READ, WRITE, UPDATE)   \
  READ(0, RenderStatus, status)              \
  READ(1, uint, visible_count)               \
  READ(2, uint, visible_ids)                 \
  READ(3, GaussianGradient, gaussian_gradients) \
  UPDATE(4, vec3, means)                     \
  UPDATE(5, vec3, means_m)                   \
  UPDATE(6, vec3, means_v)                   \
  UPDATE(7, vec3, log_scales)                \
  UPDATE(8, vec3, log_scales_m)              \
  UPDATE(9, vec3, log_scales_v)              \
  UPDATE(10, vec4, rotations)                \
  UPDATE(11, vec4, rotations_m)              \
  UPDATE(12, vec4, rotations_v)              \
  UPDATE(13, float, opacity_logits)          \
  UPDATE(14, float, opacity_logits_m)        \
  UPDATE(15, float, opacity_logits_v)        \
  UPDATE(16, uint, steps)
#include "declare_pass.h"
