#include "engine/io/trajectory_file.h"

#include <fmt/format.h>

#include <cmath>
#include <span>

#include "engine/io/files.h"
#include "engine/io/pose_numbers.h"
#include "engine/io/text_file.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

StampedPose parse_pose(const std::filesystem::path& file, const TextLine& line) {
  const auto numbers = parse_numbers(line.text);
  if (!numbers || numbers->size() != 8 || !std::isfinite(numbers->front())) {
    throw InputError(file, line.number,
                     "expected \"timestamp tx ty tz qx qy qz qw\" (8 numbers, TUM format)");
  }
  return {numbers->front(), pose_from_quaternion({file, line.number}, std::span(*numbers).subspan(1))};
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
  const std::set<int> lost = lines_after_comment(file, kLostComment);
  for (const TextLine& line : read_lines(file)) {
    trajectory.push_back(parse_pose(file, line));
    trajectory.back().lost = lost.contains(line.number);
  }
  return trajectory;
}

void write_trajectory(const std::filesystem::path& file, const Trajectory& trajectory) {
  write_file(file, [&](std::ostream& stream) {
    stream << "# timestamp tx ty tz qx qy qz qw\n";
    for (const StampedPose& pose : trajectory) {
      if (pose.lost) stream << kLostComment << "\n";
      stream << format_pose(pose);
    }
  });
}

}  // namespace surefield
