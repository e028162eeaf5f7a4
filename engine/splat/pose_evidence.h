#pragma once

#include <Eigen/Core>
#include <span>

namespace surefield {

namespace glsl {
struct AlignSums;
}

/// What the last step of an alignment says of its pose, for a small motion of the camera (translation,
/// rotation; metres and radians, in the camera's frame: T <- (Exp(phi) R, Exp(phi) t + tau)).
struct PoseEvidence {
  using Matrix = Eigen::Matrix<double, 6, 6>;
  Matrix information = Matrix::Zero();  ///< the normal matrix of all sources, undamped
  /// How much the sources disagree: the sum of the outer products of what is left of each one's slope where
  /// they balance each other.
  Matrix disagreement = Matrix::Zero();
};

/// Of two sums for each source, that of both terms and that of the photometric one; all of them count
/// `weight` times.
PoseEvidence evidence_of(std::span<const glsl::AlignSums> parts, double weight);

}  // namespace surefield
