// One step of Adam on the pose of a keyframe, beside the map (paper eq. 21).
#include "loss_types.h"

#define PASS refine_pose
#define PASS_PARAMS(P) P(float, rate_rotation) P(float, rate_translation)
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, RenderStatus, status)            \
  READ(1, PoseGradient, pose_gradient)     \
  UPDATE(2, CameraState, camera)           \
  UPDATE(3, PoseAdam, adam)
#include "declare_pass.h"
