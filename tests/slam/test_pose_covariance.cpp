#include "engine/slam/pose_covariance.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace surefield;

TEST_CASE("the more is known of a pose, and the more its parts agree, the more certain it is") {
  PoseEvidence evidence;
  evidence.information = PoseEvidence::Matrix::Identity() * 1e6;
  const double once = position_sigma(covariance_of(evidence));
  CHECK(once > 0);
  PoseEvidence more = evidence;
  more.information *= 4;
  CHECK(position_sigma(covariance_of(more)) == doctest::Approx(once / 2));
  CHECK(rotation_sigma(covariance_of(more)) == doctest::Approx(once / 2));

  PoseEvidence torn = evidence;
  torn.disagreement(0, 0) = 1e12;  // parts that pull 1 m apart along x
  CHECK(position_sigma(covariance_of(torn)) > 1);
  CHECK(rotation_sigma(covariance_of(torn)) == doctest::Approx(once));
}

TEST_CASE("sigma is that of the most uncertain direction, along no axis too") {
  PoseCovariance covariance = PoseCovariance::Zero();
  const Eigen::Vector3d along = Eigen::Vector3d(1, 2, -2) / 3;
  covariance.topLeftCorner<3, 3>() = 0.04 * along * along.transpose() + 1e-6 * Eigen::Matrix3d::Identity();
  CHECK(position_sigma(covariance) == doctest::Approx(0.2).epsilon(1e-3));
  CHECK(rotation_sigma(covariance) == 0);
}

TEST_CASE("without evidence nothing is claimed, and an open direction is infinitely uncertain") {
  CHECK(covariance_of({}).isZero(0));
  PoseEvidence open;
  open.information = PoseEvidence::Matrix::Identity() * 1e6;
  open.information(1, 1) = 0;
  CHECK(std::isinf(position_sigma(covariance_of(open))));
}

TEST_CASE(
    "a pose follows the frame where that knows more, and the prediction where it leaves a direction open") {
  PoseEvidence evidence;
  evidence.information = PoseEvidence::Matrix::Identity() * 1e10;
  evidence.information(0, 0) = -1e3;  // by chance: what noise says of an open direction
  Pose predicted = Pose::Identity();
  predicted.linear() = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()).toRotationMatrix();
  predicted.translation() = Eigen::Vector3d(1, 2, 3);
  Pose motion = Pose::Identity();
  motion.linear() = Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  motion.translation() = Eigen::Vector3d(0.03, -0.02, 0.01);
  const PredictionError error{.position = 0.005, .rotation = 0.003};
  const Pose fused = fuse(predicted, error, motion * predicted, evidence) * predicted.inverse();
  CHECK((fused.translation() - Eigen::Vector3d(0, -0.02, 0.01)).norm() < 1e-3);
  CHECK((fused.rotation() - motion.rotation()).norm() < 1e-3);

  // Half-way where both are as certain.
  evidence.information = PoseEvidence::Matrix::Identity();
  const double sigma = position_sigma(covariance_of(evidence));
  const Pose middle = fuse(predicted, {sigma, sigma}, motion * predicted, evidence) * predicted.inverse();
  CHECK((middle.translation() - motion.translation() / 2).norm() < 1e-6);
  CHECK(Eigen::AngleAxisd(middle.rotation()).angle() == doctest::Approx(0.01));

  // Nothing known of the prediction's error, or no evidence: as aligned.
  CHECK(fuse(predicted, {}, motion * predicted, evidence).isApprox(motion * predicted));
  CHECK(fuse(predicted, error, motion * predicted, {}).isApprox(motion * predicted));
}
