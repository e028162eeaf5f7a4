// Adds the pixels of one view to the uncertainty of the Gaussians that dominate them (paper eq. 13).
#include "splat_types.h"

#define PASS sum_uncertainty
#define PASS_PARAMS(P) P(uint, pixels) P(float, above) /* judged uncertain */ P(vec3, noise) /* lib/depth_noise.glsl */
#define PASS_BINDINGS(READ, WRITE, UPDATE) \
  READ(0, RenderStatus, status)            \
  READ(1, float, sensor_depth)             \
  READ(2, uint, dominators)                \
  READ(3, vec4, geometry)                  \
  READ(4, Splat, splats)                   \
  UPDATE(5, UncertaintySum, sums)
#include "declare_pass.h"
