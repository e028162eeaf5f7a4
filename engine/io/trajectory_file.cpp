#include "engine/io/trajectory_file.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "engine/io/files.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

constexpr double kSmallestQuaternion = 1e-6;

StampedPose parse_pose(const std::filesystem::path& file, const TextLine& line) {
  const auto numbers = parse_numbers(line.text);
  if (!numbers || numbers->size() != 8 || !std::isfinite(numbers->front())) {
    throw InputError(file, line.number,
                     "expected \"timestamp tx ty tz qx qy qz qw\" (8 numbers, TUM format)");
  }
  const std::vector<double>& n = *numbers;
  StampedPose pose;
  pose.timestamp = n[0];
  const Eigen::Vector3d translation(n[1], n[2], n[3]);
  Eigen::Quaterniond rotation(n[7], n[4], n[5], n[6]);
  if (!translation.allFinite() || !rotation.coeffs().allFinite()) {
    pose.camera_to_world.matrix().setConstant(std::numeric_limits<double>::quiet_NaN());
    return pose;
  }
  const double norm = rotation.norm();
  if (!(norm > kSmallestQuaternion && std::isfinite(norm))) {
    throw InputError(file, line.number, "the quaternion qx qy qz qw has no direction; it must be a rotation");
  }
  pose.camera_to_world.linear() = rotation.normalized().toRotationMatrix();
  pose.camera_to_world.translation() = translation;
  return pose;
}

std::string format_pose(const StampedPose& pose) {
  if (!pose.is_finite()) return fmt::format("{:.6f} nan nan nan nan nan nan nan\n", pose.timestamp);
  const Eigen::Vector3d t = pose.camera_to_world.translation();
  Eigen::Quaterniond q(pose.camera_to_world.linear());
  q.normalize();
  if (q.w() < 0) q.coeffs() *= -1;
  std::string line = fmt::format("{:.6f}", pose.timestamp);
  // Adding 0 turns -0 into 0, which would otherwise differ in the bytes for the same pose.
  for (double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()})
    line += fmt::format(" {:.9g}", value + 0.0);
  return line + "\n";
}

}  // namespace

Trajectory read_trajectory(const std::filesystem::path& file) {
  Trajectory trajectory;
  for (const TextLine& line : read_lines(file)) trajectory.push_back(parse_pose(file, line));
  return trajectory;
}

void write_trajectory(const std::filesystem::path& file, const Trajectory& trajectory) {
  write_file(file, [&](std::ostream& stream) {
    stream << "# timestamp tx ty tz qx qy qz qw\n";
    for (const StampedPose& pose : trajectory) stream << format_pose(pose);
  });
}

}  // namespace surefield
