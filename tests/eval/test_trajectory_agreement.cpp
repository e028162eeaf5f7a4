// ATE against a second implementation, on the true trajectories of the real clips.
#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

#include "engine/eval/trajectory_metrics.h"
#include "engine/sources/open_dataset.h"
#include "tests/support/input_files.h"

using namespace surefield;
using namespace surefield::test;

namespace {

using Points = std::vector<Eigen::Vector3d>;

Eigen::Vector3d mean(const Points& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

/// Horn's closed form with unit quaternions (1987): the rotation is the eigenvector of the largest eigenvalue
/// of a 4 x 4 matrix made of the sums of products. Nothing in common with the SVD that align() uses.
Eigen::Matrix3d horn_rotation(const Points& from, const Points& to) {
  const Eigen::Vector3d from_mean = mean(from), to_mean = mean(to);
  double s[3][3] = {};
  for (std::size_t i = 0; i < from.size(); ++i)
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) s[r][c] += (from[i][r] - from_mean[r]) * (to[i][c] - to_mean[c]);
  Eigen::Matrix4d n;
  n << s[0][0] + s[1][1] + s[2][2], s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0],  //
      s[1][2] - s[2][1], s[0][0] - s[1][1] - s[2][2], s[0][1] + s[1][0], s[2][0] + s[0][2],   //
      s[2][0] - s[0][2], s[0][1] + s[1][0], -s[0][0] + s[1][1] - s[2][2], s[1][2] + s[2][1],  //
      s[0][1] - s[1][0], s[2][0] + s[0][2], s[1][2] + s[2][1], -s[0][0] - s[1][1] + s[2][2];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(n);
  const Eigen::Vector4d q = solver.eigenvectors().col(3);
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

double horn_ate(const Points& estimate, const Points& truth) {
  const Eigen::Matrix3d rotation = horn_rotation(estimate, truth);
  const Eigen::Vector3d shift = mean(truth) - rotation * mean(estimate);
  double sum = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    sum += (rotation * estimate[i] + shift - truth[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(truth.size()));
}

/// The true poses of a clip's frames, disturbed by a slow drift and by jitter, in another world.
Trajectory disturbed(const Trajectory& truth, uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 1);
  const auto vector = [&] { return Eigen::Vector3d(noise(random), noise(random), noise(random)); };
  Eigen::Isometry3d world = Eigen::Isometry3d::Identity();
  world.linear() = Eigen::AngleAxisd(noise(random), vector().normalized()).toRotationMatrix();
  world.translation() = 10 * vector();
  Eigen::Vector3d drift = Eigen::Vector3d::Zero();
  Trajectory estimate;
  for (const StampedPose& pose : truth) {
    drift += 0.001 * vector();
    StampedPose moved = pose;
    moved.camera_to_world.translation() += drift + 0.005 * vector();
    moved.camera_to_world = world * moved.camera_to_world;
    estimate.push_back(moved);
  }
  return estimate;
}

Points positions(const Trajectory& trajectory) {
  Points points;
  for (const StampedPose& pose : trajectory) points.push_back(pose.camera_to_world.translation());
  return points;
}

}  // namespace

TEST_CASE("ATE on real trajectories equals that of Horn's quaternion method") {
  for (const char* name : {"tum_fr1_xyz", "sevenscenes_redkitchen", "replica_room0"}) {
    const auto folder = real_clip(name);
    if (folder.empty()) continue;
    CAPTURE(name);
    const Trajectory truth = *open_dataset(folder).ground_truth;
    REQUIRE(truth.size() >= 20);
    for (uint32_t seed : {1u, 2u, 3u}) {
      const Trajectory estimate = disturbed(truth, seed);
      const TrajectoryMetrics metrics = evaluate_trajectory(estimate, truth, {.max_difference = 1e-5});
      REQUIRE(metrics.pairs == static_cast<int>(truth.size()));
      const double expected = horn_ate(positions(estimate), positions(truth));
      CHECK(expected > 0.005);
      CHECK(std::abs(metrics.ate.rmse - expected) < 1e-9);
    }
  }
}
