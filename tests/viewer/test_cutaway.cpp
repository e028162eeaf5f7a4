#include "engine/viewer/cutaway.h"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

using namespace surefield;

namespace {

/// Discs with these normals, all alike otherwise.
GaussianCloud discs(const std::vector<std::pair<Eigen::Vector3f, Eigen::Vector3f>>& places_and_normals) {
  GaussianCloud cloud;
  cloud.resize(places_and_normals.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto& [place, normal] = places_and_normals[i];
    const Eigen::Quaternionf q = Eigen::Quaternionf::FromTwoVectors(Eigen::Vector3f::UnitZ(), normal);
    cloud.means[i] = place;
    cloud.rotations[i] = {q.w(), q.x(), q.y(), q.z()};
    cloud.log_scales[i] = {-4, -4, -7};
    cloud.opacity_logits[i] = 1;
  }
  return cloud;
}

/// A camera there that looks along that direction.
Pose camera(const Eigen::Vector3d& place, const Eigen::Vector3d& forward) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), forward).toRotationMatrix();
  pose.translation() = place;
  return pose;
}

const Eigen::Vector3d kMiddle(0, 0, 3);

/// Inside a room: one wall at z = 5, one at z = 1, behind the first camera, and a floor at y = 1.
GaussianCloud room_of_discs() {
  return discs({{{0, 0, 5}, {0, 0, 1}}, {{0, 0, 1}, {0, 0, 1}}, {{0.3f, 1, 2.2f}, {0, 1, 0}}});
}
const Trajectory kInside = {{0, camera({0, 0, 2}, {0, 0, 1})},
                            {1, camera({0, 0, 4}, {0, 0, -1})},
                            {2, camera({0, -0.5, 2}, {0.1, 1, 0.1})}};

std::vector<Eigen::Vector3f> shown(const Cutaway& cutaway, const Pose& from) {
  const GaussianCloud seen = cutaway.seen_from(from, kMiddle);
  REQUIRE(seen.is_consistent());
  return seen.means;
}

}  // namespace

TEST_CASE("a wall is cut away where it is seen from behind") {
  const GaussianCloud room = room_of_discs();
  const Cutaway cutaway(room, kInside);
  using Places = std::vector<Eigen::Vector3f>;
  CHECK(shown(cutaway, camera({0, -1, -2}, {0, 0.2, 1})) == Places{room.means[0], room.means[2]});
  CHECK(shown(cutaway, camera({0, -1, 8}, {0, 0.2, -1})) == Places{room.means[1], room.means[2]});
  // Whichever way the discs' axes point.
  GaussianCloud turned =
      discs({{{0, 0, 5}, {0, 0, -1}}, {{0, 0, 1}, {0, 0, -1}}, {{0.3f, 1, 2.2f}, {0, -1, 0}}});
  CHECK(shown(Cutaway(turned, kInside), camera({0, -1, -2}, {0, 0.2, 1})).size() == 2);
  // The camera in the room has all before it, and what it shows is as it was.
  const GaussianCloud inside = cutaway.seen_from(camera({0, 0, 2}, {0, 0, 1}), kMiddle);
  CHECK(inside.opacity_logits[0] == room.opacity_logits[0]);
}

TEST_CASE("without cameras no side is a front, and only what is before the lens is cut away") {
  const GaussianCloud room = room_of_discs();
  const Cutaway cutaway(room, {});
  CHECK(shown(cutaway, camera({0, -1, -2}, {0, 0.2, 1})).size() == 3);
  CHECK(shown(cutaway, camera({0, 0, 0.5}, {0, 0, 1})).size() == 2);
}

TEST_CASE("what is no disc has its front where it was seen from") {
  GaussianCloud ball = discs({{{0, 0, 2}, {0, 0, 1}}});
  ball.log_scales[0].setConstant(-4);
  const Cutaway cutaway(ball, {{0, camera({0, 0, 3}, {0, 0, -1})}});
  CHECK(shown(cutaway, camera({0, 0, 0}, {0, 0, 1})).empty());
  CHECK(shown(cutaway, camera({0, 0, 6}, {0, 0, -1})).size() == 1);
}

TEST_CASE("nothing appears or vanishes at once on the way of a camera") {
  const Cutaway cutaway(room_of_discs(), kInside);
  std::vector<double> last;
  for (int step = 0; step <= 720; ++step) {
    const double angle = M_PI * step / 360;
    const Eigen::Vector3d out(std::sin(angle), -0.4, -std::cos(angle));
    const GaussianCloud seen = cutaway.seen_from(camera(kMiddle + 4 * out, -out), kMiddle);
    std::vector<double> opacities(3, 0);
    for (std::size_t k = 0; k < seen.size(); ++k)
      for (std::size_t i = 0; i < 3; ++i)
        if (seen.means[k] == room_of_discs().means[i])
          opacities[i] = 1 / (1 + std::exp(-seen.opacity_logits[k]));
    for (std::size_t i = 0; i < last.size(); ++i) CHECK(std::abs(opacities[i] - last[i]) < 0.1);
    last = opacities;
  }
}
