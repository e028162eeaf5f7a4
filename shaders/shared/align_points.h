// The points and normals of an image, rendered or a keyframe's.
#include "align_types.h"

#define PASS align_points
#define PASS_PARAMS(P) P(uint, width) P(uint, height) P(uint, level) P(float, unknown) /* as AlignPoint::depth where the image has none */
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, CameraState, camera)             \
  READ(1, vec2, image)                     \
  WRITE(2, AlignPoint, points)
#include "declare_pass.h"
