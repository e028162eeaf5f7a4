#include <doctest/doctest.h>

#include <cmath>

#include "engine/viewer/view_camera.h"

using namespace surefield;

namespace {

Pose tilted() {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  pose.translation() = Eigen::Vector3d(0.4, -0.2, 1.1);
  return pose;
}

/// The point that is looked at.
Eigen::Vector3d looked_at(const ViewCamera& camera) {
  return camera.camera_to_world() * Eigen::Vector3d(0, 0, camera.distance());
}

void check_upright(const ViewCamera& camera) {
  const Eigen::Matrix3d axes = camera.camera_to_world().linear();
  CHECK((axes.transpose() * axes - Eigen::Matrix3d::Identity()).norm() < 1e-9);
  CHECK(axes.determinant() == doctest::Approx(1));
  CHECK(axes.col(0).y() == doctest::Approx(0));  // x is level
  CHECK(axes.col(1).y() > 0);                    // y is down
}

}  // namespace

TEST_CASE("who follows sees the camera and what it sees, from behind and above") {
  ViewCamera camera;
  camera.follow(tilted());
  check_upright(camera);
  const Eigen::Vector3d seen = camera.camera_to_world().inverse() * tilted().translation();
  CHECK(seen.z() > 0.3);
  CHECK(seen.y() > 0);
  CHECK((looked_at(camera) - tilted() * Eigen::Vector3d(0, 0, 1)).norm() < 1e-9);
}

TEST_CASE("orbiting keeps the point that is looked at, turning keeps the place") {
  ViewCamera camera;
  camera.overlook({1, 2, 3}, 2);
  camera.orbit(0.7, -0.2);
  camera.orbit(-2.5, 9);  // as far down as it goes
  CHECK((looked_at(camera) - Eigen::Vector3d(1, 2, 3)).norm() < 1e-9);
  check_upright(camera);
  const Eigen::Vector3d place = camera.camera_to_world().translation();
  camera.turn(1, 0.1);
  CHECK(camera.camera_to_world().translation() == place);
  CHECK((looked_at(camera) - Eigen::Vector3d(1, 2, 3)).norm() > 0.2);
}

TEST_CASE("a drag to the right turns what is seen to the right") {
  ViewCamera camera;
  camera.overlook({0, 0, 0}, 1);
  const Eigen::Vector3d front(0, 0, -0.1);  // of the point looked at, towards the camera
  const auto column = [&] {
    const Camera view = camera.camera(200, 200);
    const Eigen::Vector3d p = view.world_to_camera * front;
    return p.x() / p.z();
  };
  const double before = column();
  camera.orbit(0.2, 0);
  CHECK(column() > before);
}

TEST_CASE("looking through a camera, its whole image is seen, at its place in the window") {
  const Camera tracked{{.width = 64, .height = 48, .fx = 60, .fy = 58, .cx = 30, .cy = 25},
                       tilted().inverse()};
  ViewCamera camera;
  camera.look_through(tracked);
  for (const auto& size : {std::pair{128, 96}, {400, 96}, {100, 700}}) {
    const Camera view = camera.camera(size.first, size.second);
    CHECK(view.world_to_camera.isApprox(tracked.world_to_camera));
    const Intrinsics& k = view.intrinsics;
    for (const auto& [corner_u, corner_v] : {std::pair{-0.5, -0.5}, {63.5, 47.5}}) {
      const double u = (corner_u - 30) / 60 * k.fx + k.cx, v = (corner_v - 25) / 58 * k.fy + k.cy;
      CHECK(u >= -0.5 - 1e-9);
      CHECK(u <= k.width - 0.5 + 1e-9);
      CHECK(v >= -0.5 - 1e-9);
      CHECK(v <= k.height - 0.5 + 1e-9);
    }
  }
  const Camera same = camera.camera(128, 96);
  CHECK(same.intrinsics.fx == doctest::Approx(120));
  CHECK(same.intrinsics.cx == doctest::Approx(tracked.intrinsics.scaled(2).cx));
}

TEST_CASE("panning moves what is looked at with the mouse, approaching stops before it") {
  ViewCamera camera;
  camera.overlook({0, 0, 0}, 1);
  const Eigen::Vector3d point(0, 0, 0);
  const auto pixel = [&] {
    const Camera view = camera.camera(300, 200);
    const Eigen::Vector3d p = view.world_to_camera * point;
    const Intrinsics& k = view.intrinsics;
    return Eigen::Vector2d(k.fx * p.x() / p.z() + k.cx, k.fy * p.y() / p.z() + k.cy);
  };
  const Eigen::Vector2d before = pixel();
  camera.pan(30, -20, 200);
  CHECK((pixel() - before - Eigen::Vector2d(30, -20)).norm() < 1e-6);
  for (int i = 0; i < 100; ++i) camera.approach(0.5);
  CHECK(camera.distance() > 0.01);
}

TEST_CASE("a view stands and turns about what is up") {
  const Eigen::Vector3d up = Eigen::Vector3d(0.3, -0.9, 0.2).normalized();
  ViewCamera camera;
  camera.set_up(up);
  const auto check_level = [&] {
    const Eigen::Matrix3d axes = camera.camera_to_world().linear();
    CHECK(std::abs(axes.col(0).dot(up)) < 1e-9);
    CHECK(axes.col(1).dot(up) < 0);  // the image's down
  };
  camera.overlook({0, 0, 2}, 1);
  check_level();
  CHECK((camera.camera_to_world().translation() - Eigen::Vector3d(0, 0, 2)).dot(up) > 0);  // from above
  for (int i = 0; i < 7; ++i) {
    camera.orbit(0.9, i % 2 ? -0.3 : 0.4);
    check_level();
  }
  Pose tracked = Pose::Identity();
  tracked.translation() = Eigen::Vector3d(1, 2, 3);
  camera.follow(tracked);
  check_level();
  camera.turn(1.0, 0.2);
  check_level();
}
