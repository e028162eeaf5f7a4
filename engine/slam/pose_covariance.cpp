#include "engine/slam/pose_covariance.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace surefield {

namespace {

// Neighbouring pixels err together, and all of them with the map: by so much the covariance is larger than
// that of as many independent pixels, measured against truth (docs/experiments.md).
constexpr double kTogether = 100;
// And by so much what the parts disagree by, for what all of them have in common.
constexpr double kCommon = 5;
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

Pose fuse(const Pose& predicted, const PredictionError& error, const Pose& aligned,
          const PoseEvidence& evidence) {
  using Matrix = PoseEvidence::Matrix;
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(evidence.information);
  const auto& values = solver.eigenvalues();
  if (!(values.maxCoeff() > 0) || !(error.position > 0) || !(error.rotation > 0)) return aligned;
  const Matrix H = solver.eigenvectors() * values.cwiseMax(kOpen * values.maxCoeff()).asDiagonal() *
                   solver.eigenvectors().transpose();
  // The inverse of covariance_of(), without inverting what is nearly singular.
  const Matrix known = H * (kTogether * H + kCommon * evidence.disagreement).ldlt().solve(H);
  Matrix prior = Matrix::Zero();
  prior.diagonal().head<3>().setConstant(1 / (error.position * error.position));
  prior.diagonal().tail<3>().setConstant(1 / (error.rotation * error.rotation));
  const Pose motion = aligned * predicted.inverse();
  const Eigen::AngleAxisd turn(motion.rotation());
  Eigen::Matrix<double, 6, 1> measured;
  measured << motion.translation(), turn.angle() * turn.axis();
  const Eigen::Matrix<double, 6, 1> likely = (known + prior).ldlt().solve(known * measured);
  const Eigen::Vector3d phi = likely.tail<3>();
  Pose step = Pose::Identity();
  if (phi.norm() > 0) step.linear() = Eigen::AngleAxisd(phi.norm(), phi.normalized()).toRotationMatrix();
  step.translation() = likely.head<3>();
  return step * predicted;
}

double position_sigma(const PoseCovariance& covariance) {
  return largest_sigma(covariance.topLeftCorner<3, 3>());
}

double rotation_sigma(const PoseCovariance& covariance) {
  return largest_sigma(covariance.bottomRightCorner<3, 3>());
}

}  // namespace surefield
