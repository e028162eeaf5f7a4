#include "engine/viewer/up_direction.h"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

using namespace surefield;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Discs on a rectangle about `middle` with these half sides, both metres, and noise on places and normals.
void add_rectangle(GaussianCloud& cloud, std::mt19937& random, const Eigen::Vector3d& middle,
                   const Eigen::Vector3d& one, const Eigen::Vector3d& other, int count) {
  std::uniform_real_distribution<double> side(-1, 1);
  std::normal_distribution<double> noise;
  const auto any = [&] { return Eigen::Vector3d(noise(random), noise(random), noise(random)); };
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d normal = (one.cross(other).normalized() + 0.1 * any()).normalized();
    const Eigen::Quaterniond q = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal);
    cloud.means.push_back((middle + side(random) * one + side(random) * other + 0.01 * any()).cast<float>());
    cloud.rotations.emplace_back(q.cast<float>().w(), q.cast<float>().x(), q.cast<float>().y(),
                                 q.cast<float>().z());
  }
}

/// A room with y down: floor, two walls and a table, and a slanted roof.
GaussianCloud room() {
  std::mt19937 random(5);
  GaussianCloud cloud;
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  add_rectangle(cloud, random, 1.4 * y + 2 * z, 2 * x, 2 * z, 1500);
  add_rectangle(cloud, random, 4 * z, 2 * x, 1.4 * y, 1000);
  add_rectangle(cloud, random, -2 * x + 2 * z, 2 * z, 1.4 * y, 1000);
  add_rectangle(cloud, random, 0.6 * y + 3 * z, 0.8 * x, 0.4 * z, 400);
  add_rectangle(cloud, random, -1.4 * y + 2 * z, 2 * x, Eigen::Vector3d(0, 0.7, 2), 1200);
  cloud.log_scales.assign(cloud.means.size(), Eigen::Vector3f(-4, -4, -7));
  const std::size_t count = cloud.means.size();
  cloud.opacity_logits.assign(count, 2);
  cloud.sh.assign(3 * count, 0);
  cloud.uncertainty.assign(count, 0);
  cloud.sampling.assign(count, 0);
  cloud.anchors.assign(count, 0);
  return cloud;
}

void turn(GaussianCloud& cloud, const Eigen::Quaterniond& by) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.means[i] = (by * cloud.means[i].cast<double>()).cast<float>();
    const Eigen::Vector4f q = cloud.rotations[i];
    const Eigen::Quaternionf turned = by.cast<float>() * Eigen::Quaternionf(q[0], q[1], q[2], q[3]);
    cloud.rotations[i] = {turned.w(), turned.x(), turned.y(), turned.z()};
  }
}

double degrees_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0)) / kDegree;
}

}  // namespace

TEST_CASE("up is told by floors, tables and walls, however the first camera was tilted") {
  const Trajectory first{{0, Eigen::Isometry3d::Identity()}};
  for (const double pitch : {-20.0, 0.0, 25.0, 50.0})
    for (const double roll : {-8.0, 0.0, 10.0}) {
      CAPTURE(pitch);
      CAPTURE(roll);
      const Eigen::Quaterniond tilt = Eigen::AngleAxisd(roll * kDegree, Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(pitch * kDegree, Eigen::Vector3d::UnitX());
      GaussianCloud cloud = room();
      turn(cloud, tilt);
      const UpDirection found = find_up(cloud, first);
      CHECK(found.measured);
      CHECK(degrees_between(found.up, tilt * -Eigen::Vector3d::UnitY()) < 0.3);
    }
}

TEST_CASE("without level planes, up is as the cameras were held") {
  Eigen::Isometry3d held = Eigen::Isometry3d::Identity();
  held.linear() = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Trajectory trajectory{{0, held}};
  const Eigen::Vector3d up = held.linear() * -Eigen::Vector3d::UnitY();
  const auto check = [&](const GaussianCloud& cloud) {
    const UpDirection found = find_up(cloud, trajectory);
    CHECK_FALSE(found.measured);
    CHECK(found.up.isApprox(up));
  };
  check({});
  GaussianCloud ball;  // surface in all directions
  ball.resize(2000);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < ball.size(); ++i) {
    const Eigen::Vector3d out = Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    const Eigen::Quaternionf q =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), out).cast<float>();
    ball.means[i] = (0.3 * out).cast<float>();
    ball.rotations[i] = {q.w(), q.x(), q.y(), q.z()};
    ball.log_scales[i] = {-4, -4, -7};
    ball.opacity_logits[i] = 2;
  }
  check(ball);
  GaussianCloud faint = room();
  faint.opacity_logits.assign(faint.size(), -5);
  check(faint);
  CHECK_FALSE(find_up(room(), {}).up.isZero());
}
