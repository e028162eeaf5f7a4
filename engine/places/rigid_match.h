#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "engine/places/local_features.h"
#include "engine/types/camera.h"
#include "engine/types/depth_noise.h"
#include "engine/types/frame.h"

namespace surefield {

/// Features of a frame that have depth: a row of `descriptors` for each of `points`.
struct PlacedFeatures {
  FeatureBytes descriptors;             ///< root_sift()
  std::vector<Eigen::Vector3f> points;  ///< camera frame, metres
};

/// The features of a frame at whose pixels the depth is smooth. The intrinsics are those of its images.
PlacedFeatures place_features(const Frame& frame, const Intrinsics& intrinsics);

/// A motion that makes the points of one frame those of another.
struct RigidMatch {
  Pose from_to = Pose::Identity();  ///< maps points of the first to the frame of the second
  int matches = 0;                  ///< features that look alike
  int inliers = 0;                  ///< of those, the ones that the motion lays on each other
  /// How far these spread over the second image in the direction in which they do least: the standard
  /// deviation of (x / z, y / z), pixels over the focal length.
  double spread = 0;
};

/// Finds the motion between two frames without knowing anything of it: features that are each other's nearest
/// and clearly so are matched, and the rigid motion is taken that lays most of the matched points on each
/// other, up to the larger of 2 cm and three deviations of the depth (500 samples of three matches, the same
/// ones each time). Nothing where fewer than `fewest` are.
std::optional<RigidMatch> match_rigidly(const PlacedFeatures& from, const PlacedFeatures& to,
                                        const DepthNoise& noise, int fewest);

}  // namespace surefield
