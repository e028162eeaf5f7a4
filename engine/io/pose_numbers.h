#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <span>

namespace surefield {

/// Where in a text file numbers stand, for errors.
struct TextPlace {
  const std::filesystem::path& file;
  int line = 0;
};

/// The pose whose numbers are tx ty tz qx qy qz qw; the quaternion is normalised. Not finite where a number
/// is not. Throws InputError where the quaternion has no direction.
Eigen::Isometry3d pose_from_quaternion(const TextPlace& place, std::span<const double> numbers);

/// The pose whose 4 x 4 matrix stands there row by row, or its first three rows (12 numbers). Not finite
/// where a number is not. Throws InputError where the matrix is not rigid.
Eigen::Isometry3d pose_from_rows(const TextPlace& place, std::span<const double> numbers);

/// The pose, camera to world, of a camera that looks along its -z axis with y up, as of our camera: z
/// forward, y down.
Eigen::Isometry3d pose_of_looking_back(const Eigen::Isometry3d& camera_to_world);

}  // namespace surefield
