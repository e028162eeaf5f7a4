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
