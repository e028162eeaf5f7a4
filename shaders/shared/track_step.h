// One step of Adam on the pose being tracked; keeps the pose of the lowest loss.
#include "loss_types.h"

#define PASS track_step
#define PASS_PARAMS(P)                                                                       \
  P(float, rate_rotation) P(float, rate_translation) P(float, weight_colour) P(float, weight_depth) \
  P(float, sensor_pixels) /* with depth */
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, RenderStatus, status)            \
  READ(1, PoseGradient, pose_gradient)     \
  READ(2, TrackSums, sums)                 \
  READ(3, uint, histograms) /* track_residuals.h */ \
  UPDATE(4, CameraState, camera)           \
  UPDATE(5, TrackState, state)
#include "declare_pass.h"
