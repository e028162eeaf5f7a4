// Gaussians follow the keyframes that they were born in.
#include "splat_types.h"

SHARED_TYPES_BEGIN

/// How what was born in a keyframe moves in the world: x <- R x + t.
struct AnchorMotion {
  vec4 rotation;       // unit quaternion w, x, y, z
  vec3 translation;
};

/// Moments are those of the place where they were gathered: they start anew where a Gaussian moves by more, metres.
SHARED_CONST float MOMENTS_REACH = 1e-3f;

SHARED_TYPES_END

#define PASS move_gaussians
#define PASS_PARAMS(P) P(uint, count) P(uint, anchors) /* motions; what was born in a later keyframe stays */
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, AnchorMotion, motions)           \
  READ(1, uint, anchors)                   \
  UPDATE(2, vec3, means)                   \
  UPDATE(3, vec3, means_m)                 \
  UPDATE(4, vec3, means_v)                 \
  UPDATE(5, vec4, rotations)               \
  UPDATE(6, vec4, rotations_m)             \
  UPDATE(7, vec4, rotations_v)
#include "declare_pass.h"
