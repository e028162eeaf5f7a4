#pragma once

#include <limits>

#include "engine/synth/scene.h"
#include "engine/types/camera.h"

namespace surefield::testing {

/// Where a ray meets a scene, in double precision.
struct ReferenceHit {
  double depth = std::numeric_limits<double>::infinity();  ///< in lengths of the ray's direction
  int shape = -1;                                          ///< of Scene::shapes; -1 where nothing is hit
};

/// The first surface along a ray, found the plain way: face by face and root by root in the frame of each
/// body. Bodies that hold the origin are not seen.
ReferenceHit reference_cast(const Scene& scene, const Eigen::Vector3d& origin,
                            const Eigen::Vector3d& direction);

/// The ray through a pixel, with camera z = 1, so that the distance along it is the depth.
Eigen::Vector3d pixel_ray(const Camera& camera, double u, double v);

}  // namespace surefield::testing
