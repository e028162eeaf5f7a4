#include "engine/synth/room.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace surefield;
using Eigen::Vector3d;

namespace {

const Intrinsics kIntrinsics{80, 60, 68, 68, 39.5, 29.5};

/// A camera at `position` whose axes right, down and forward are the given world directions.
Camera camera_at(const Vector3d& position, const Vector3d& right, const Vector3d& forward) {
  Camera camera{kIntrinsics, Pose::Identity()};
  Eigen::Matrix3d rotation;
  rotation << right.transpose(), forward.cross(right).transpose(), forward.transpose();
  camera.world_to_camera.linear() = rotation;
  camera.world_to_camera.translation() = -rotation * position;
  return camera;
}

}  // namespace

TEST_CASE("depth of a plane seen head on is its distance at every pixel") {
  const SyntheticRoom room;
  const Frame ceiling = room.render(camera_at({2.5, 2.0, 1.9}, Vector3d::UnitX(), Vector3d::UnitZ()));
  REQUIRE(ceiling.depth.size() == cv::Size(80, 60));
  double low = 0, high = 0;
  cv::minMaxLoc(ceiling.depth, &low, &high);
  CHECK(low == doctest::Approx(0.8).epsilon(1e-6));
  CHECK(high == doctest::Approx(0.8).epsilon(1e-6));
}

TEST_CASE("depth of a slanted view of the ceiling is camera z, not the length of the ray") {
  const SyntheticRoom room;
  const double pitch = 0.6;
  const Vector3d forward(0, std::cos(pitch), std::sin(pitch));
  const Vector3d position(2.5, 1.0, 1.9);
  const Frame frame = room.render(camera_at(position, Vector3d::UnitX(), forward));
  // Along camera z = 1 the ray climbs by sin(pitch) - y cos(pitch), y being the normalised row coordinate.
  const double row = 0;
  const double climb = std::sin(pitch) - (row - kIntrinsics.cy) / kIntrinsics.fy * std::cos(pitch);
  for (int u = 0; u < kIntrinsics.width; ++u) {
    CHECK(frame.depth.at<float>(0, u) == doctest::Approx((2.7 - position.z()) / climb).epsilon(1e-6));
  }
}

TEST_CASE("every ray along the path meets a surface that faces it and has a finite colour") {
  const SyntheticRoom room;
  for (int second = 0; second < 27; ++second) {
    const Pose to_world = room.world_to_camera(second).inverse();
    const Vector3d origin = to_world.translation();
    int wrong = 0;
    for (int i = 0; i < 500; ++i) {
      const auto random = [&](uint32_t channel) { return lattice_noise(second, i, channel) - 0.5; };
      const Vector3d direction = Vector3d(random(1), random(2), random(3)).normalized();
      const SurfacePoint hit = room.cast(origin, direction);
      const Vector3d point = origin + hit.distance * direction;
      const bool inside =
          (point.array() > -1e-9).all() && (point.array() < SyntheticRoom::size().array() + 1e-9).all();
      const Eigen::Vector3f colour = texture(*hit.material, hit.uv);
      const bool sound = inside && hit.distance > 0.3 && std::abs(hit.normal.norm() - 1) < 1e-9 &&
                         hit.normal.dot(direction) <= 1e-9 && colour.allFinite() && colour.minCoeff() >= 0;
      if (!sound) ++wrong;
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("a ray parallel to the walls is cast correctly") {
  const SyntheticRoom room;
  const SurfacePoint hit = room.cast({2.0, 2.0, 2.3}, {0, 1, 0});
  CHECK(hit.distance == doctest::Approx(2.0));
  CHECK(hit.normal.isApprox(Vector3d(0, -1, 0)));
}

TEST_CASE("the camera moves like a hand, stays in the room and never tilts far") {
  const SyntheticRoom room;
  const double step = 1.0 / 30;
  for (double t = 0; t < 30; t += step) {
    const Pose now = room.world_to_camera(t).inverse(), next = room.world_to_camera(t + step).inverse();
    const double speed = (next.translation() - now.translation()).norm() / step;
    const double turn = Eigen::AngleAxisd(now.linear().transpose() * next.linear()).angle() / step;
    REQUIRE(speed > 0.1);
    REQUIRE(speed < 0.5);
    REQUIRE(turn < 0.6);
    REQUIRE((now.translation().array() > 0.5).all());
    REQUIRE((now.translation().array() < SyntheticRoom::size().array() - 0.5).all());
    REQUIRE(now.linear().determinant() == doctest::Approx(1));
    REQUIRE(now.linear().col(1).z() < -0.7);  // the camera's y axis points down
  }
}

TEST_CASE("the same seed gives the same bits, another seed another picture") {
  const Camera camera{kIntrinsics, SyntheticRoom(3).world_to_camera(0.5)};
  const Frame first = SyntheticRoom(3).render(camera), again = SyntheticRoom(3).render(camera);
  CHECK(cv::norm(first.colour, again.colour, cv::NORM_INF) == 0);
  CHECK(cv::norm(first.depth, again.depth, cv::NORM_INF) == 0);
  CHECK(cv::norm(first.colour, SyntheticRoom(4).render(camera).colour, cv::NORM_INF) > 0);
}
