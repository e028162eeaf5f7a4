#pragma once

#include <cstdint>
#include <vector>

#include "engine/types/camera.h"
#include "engine/types/gaussian_cloud.h"

namespace surefield::reference {

/// What the Gaussians of a random scene are like.
enum class SceneKind {
  isotropic_small,    ///< radius of about a pixel, inside the image
  anisotropic,        ///< scales differ by up to 30, any orientation, inside the image
  behind_camera,      ///< half of them behind the camera or nearer than the near plane
  at_border,          ///< around the image border; some beyond the clamp of the tangents
  larger_than_image,  ///< standard deviations of about the width of the image
  low_opacity,        ///< opacities of 0.0005 to 0.02, around the 1/255 cut
  high_opacity,  ///< opacities of 0.98 to 0.9999, around the 0.99 clamp; large, so that blending stops early
  mixed,         ///< each Gaussian of one of the kinds above
};

/// All kinds, for tests which run over them.
inline constexpr SceneKind all_scene_kinds[] = {
    SceneKind::isotropic_small,   SceneKind::anisotropic, SceneKind::behind_camera, SceneKind::at_border,
    SceneKind::larger_than_image, SceneKind::low_opacity, SceneKind::high_opacity,  SceneKind::mixed};

/// How a random scene is made.
struct SceneOptions {
  SceneKind kind = SceneKind::mixed;
  int sh_degree = 0;  ///< 0 to 3
  int width = 48;     ///< pixels
  int height = 36;    ///< pixels
};

/// A random scene and a random observation of it.
struct Scene {
  GaussianCloud cloud;
  Camera camera;  ///< a pose that is no symmetry of anything, principal point off centre, fx != fy
  std::vector<float>
      depth;  ///< sensor depth, 1 to 4 m; about one pixel in six is invalid (0, negative, NaN, Inf)
  std::vector<float> colour;  ///< RGB in [0, 1], row-major
};

/// A scene of `count` Gaussians at 1 to 4 m from the camera (but for those behind it). The same arguments
/// give the same scene on every platform. Quaternions are not of unit length; some colours are clamped at 0.
Scene random_scene(uint32_t seed, int count, const SceneOptions& options = {});

}  // namespace surefield::reference
