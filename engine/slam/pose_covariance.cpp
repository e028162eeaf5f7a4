#include "engine/slam/pose_covariance.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace surefield {

namespace {

// Neighbouring pixels err together, and all of them with the map: by so much the covariance is larger than
// that of as many independent pixels, measured against truth (docs/experiments.md).
constexpr double kTogether = 150;
// And by so much what the parts disagree by, for what all of them have in common.
constexpr double kCommon = 7.5;
// A direction is open where so much less is known of it than of the best known one: single precision tells no
// less.
constexpr double kOpen = 1e-7;

double largest_sigma(const Eigen::Matrix3d& block) {
  if (!block.allFinite()) return std::numeric_limits<double>::infinity();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(block, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(solver.eigenvalues().maxCoeff(), 0.0));
}

}  // namespace

PoseCovariance covariance_of(const PoseEvidence& evidence) {
  if (evidence.information.isZero(0)) return PoseCovariance::Zero();
  const Eigen::SelfAdjointEigenSolver<PoseEvidence::Matrix> solver(evidence.information);
  const auto& values = solver.eigenvalues();
  if (!(values.minCoeff() > kOpen * values.maxCoeff()))
    return PoseCovariance::Constant(std::numeric_limits<double>::infinity());
  const PoseCovariance inverse =
      solver.eigenvectors() * values.cwiseInverse().asDiagonal() * solver.eigenvectors().transpose();
  return kTogether * inverse + kCommon * inverse * evidence.disagreement * inverse;
}

double position_sigma(const PoseCovariance& covariance) {
  return largest_sigma(covariance.topLeftCorner<3, 3>());
}

double rotation_sigma(const PoseCovariance& covariance) {
  return largest_sigma(covariance.bottomRightCorner<3, 3>());
}

}  // namespace surefield
