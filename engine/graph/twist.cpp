#include "engine/graph/twist.h"

#include <cmath>

namespace surefield {

namespace {

constexpr double kSmallAngle = 1e-4;  // below it a series of two terms is exact to double precision

}  // namespace

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  const double half_sine = angle < kSmallAngle ? 0.5 - angle * angle / 48 : std::sin(angle / 2) / angle;
  Eigen::Quaterniond q;
  q.w() = std::cos(angle / 2);
  q.vec() = half_sine * phi;
  return q.normalized().toRotationMatrix();
}

Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& rotation) {
  Eigen::Quaterniond q(rotation);
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  const double angle = 2 * std::atan2(sine, q.w());
  const double factor =
      sine < kSmallAngle ? 2 / q.w() * (1 - sine * sine / (3 * q.w() * q.w())) : angle / sine;
  return factor * q.vec();
}

Eigen::Matrix3d left_jacobian_inverse(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  const double factor = angle < 1e-2 ? 1.0 / 12 + angle * angle / 720 + std::pow(angle, 4) / 30240
                                     : 1 / (angle * angle) - 1 / (2 * angle * std::tan(angle / 2));
  const Eigen::Matrix3d cross = cross_matrix(phi);
  return Eigen::Matrix3d::Identity() - 0.5 * cross + factor * cross * cross;
}

Pose moved(const Pose& pose, const Vector6& d) {
  const Eigen::Matrix3d turn = rotation_of(d.tail<3>());
  Pose result = Pose::Identity();
  result.linear() = Eigen::Quaterniond(Eigen::Matrix3d(turn * pose.linear())).normalized().toRotationMatrix();
  result.translation() = turn * pose.translation() + d.head<3>();
  return result;
}

Vector6 motion_between(const Pose& from, const Pose& to) {
  const Eigen::Matrix3d turn = to.linear() * from.linear().transpose();
  Vector6 d;
  d << to.translation() - turn * from.translation(), rotation_vector(turn);
  return d;
}

Matrix6 motion_jacobian(const Vector6& motion) {
  Matrix6 jacobian = Matrix6::Identity();
  jacobian.topRightCorner<3, 3>() = -cross_matrix(motion.head<3>());
  jacobian.bottomRightCorner<3, 3>() = left_jacobian_inverse(motion.tail<3>());
  return jacobian;
}

Matrix6 adjoint(const Pose& pose) {
  Matrix6 result = Matrix6::Zero();
  result.topLeftCorner<3, 3>() = result.bottomRightCorner<3, 3>() = pose.linear();
  result.topRightCorner<3, 3>() = cross_matrix(pose.translation()) * pose.linear();
  return result;
}

}  // namespace surefield
