#include "engine/io/pose_numbers.h"

#include <cmath>
#include <limits>
#include <vector>

#include "engine/io/files.h"
#include "engine/io/text_file.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr double kSmallestQuaternion = 1e-6;

}  // namespace

Eigen::Isometry3d pose_from_quaternion(const TextPlace& place, std::span<const double> numbers) {
  const Eigen::Vector3d translation(numbers[0], numbers[1], numbers[2]);
  const Eigen::Quaterniond rotation(numbers[6], numbers[3], numbers[4], numbers[5]);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (!translation.allFinite() || !rotation.coeffs().allFinite()) {
    pose.matrix().setConstant(std::numeric_limits<double>::quiet_NaN());
    return pose;
  }
  const double norm = rotation.norm();
  if (!(norm > kSmallestQuaternion && std::isfinite(norm))) {
    throw InputError(place.file, place.line,
                     "the quaternion qx qy qz qw has no direction; it must be a rotation");
  }
  pose.linear() = rotation.normalized().toRotationMatrix();
  pose.translation() = translation;
  return pose;
}

Eigen::Isometry3d pose_from_rows(const TextPlace& place, std::span<const double> numbers) {
  std::vector<double> rows(numbers.begin(), numbers.end());
  if (rows.size() == 12) rows.insert(rows.end(), {0, 0, 0, 1});
  const auto pose = rigid_from_rows(rows);
  if (!pose) {
    throw InputError(place.file, place.line,
                     "is no rigid transform: its rotation must be orthonormal within 1 percent");
  }
  return *pose;
}

Eigen::Isometry3d pose_of_looking_back(const Eigen::Isometry3d& camera_to_world) {
  Eigen::Isometry3d pose = camera_to_world;
  pose.linear() = (camera_to_world.linear() * Eigen::DiagonalMatrix<double, 3>(1, -1, -1)).eval();
  return pose;
}

}  // namespace surefield
