// Takes the camera that was just rendered as the base of the alignment, and keeps the best one.
#include "align_types.h"

#define PASS align_begin
#define PASS_PARAMS(P) P(float, weight_colour) P(float, weight_depth) P(float, sensor_pixels) /* with depth */
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, RenderStatus, status)            \
  READ(1, CameraState, camera)             \
  READ(2, TrackSums, sums)                 \
  READ(3, uint, histograms) /* track_residuals.h */ \
  UPDATE(4, AlignState, state)
#include "declare_pass.h"
