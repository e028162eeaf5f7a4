#include "engine/synth/camera_path.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>

#include "engine/types/error.h"

using namespace surefield;
using Eigen::Vector3d;

namespace {

constexpr double kFrame = 1.0 / 30;

struct Speeds {
  double slowest = 1e9, fastest = 0;  ///< metres a second
  double fastest_turn = 0;            ///< degrees a second
  double largest_tilt = 0;            ///< degrees, of the image's horizontal against the world's
  double nearest = 1e9;               ///< metres, to any body
};

Speeds measure(const Scene& scene, const CameraPath& path, double seconds) {
  Speeds speeds;
  for (double t = 0; t + kFrame < seconds; t += kFrame) {
    const Pose now = path.world_to_camera(t).inverse(), next = path.world_to_camera(t + kFrame).inverse();
    const double speed = (next.translation() - now.translation()).norm() / kFrame;
    const double turn = Eigen::AngleAxisd(now.linear().transpose() * next.linear()).angle() / kFrame;
    speeds.slowest = std::min(speeds.slowest, speed);
    speeds.fastest = std::max(speeds.fastest, speed);
    speeds.fastest_turn = std::max(speeds.fastest_turn, turn * 180 / std::numbers::pi);
    speeds.largest_tilt =
        std::max(speeds.largest_tilt, std::abs(std::asin(now.linear()(2, 0))) * 180 / std::numbers::pi);
    speeds.nearest = std::min(speeds.nearest, scene.clearance(now.translation()));
  }
  return speeds;
}

}  // namespace

TEST_CASE("every path keeps its speed, turns within its limit and runs into nothing, in every scene") {
  struct Bounds {
    const char* path;
    double slowest, fastest, turn, tilt;
  };
  const Bounds all[] = {{"robot", 0.15, 0.35, 30, 0.01},
                        {"handheld", 0.3, 0.6, 60, 3},
                        {"fast", 0.8, 1.2, 120, 4},
                        {"loop", 0.3, 0.6, 60, 3},
                        {"turn", 0.3, 0.5, 60, 3}};
  for (const std::string& name : scene_names()) {
    const Scene scene = make_scene(name, 1);
    for (const Bounds& bounds : all) {
      CAPTURE(name);
      CAPTURE(std::string(bounds.path));
      constexpr double kSeconds = 30;
      const Speeds speeds = measure(scene, CameraPath(scene, path_style(bounds.path), 1, kSeconds), kSeconds);
      CHECK(speeds.slowest > bounds.slowest);
      CHECK(speeds.fastest < bounds.fastest);
      CHECK(speeds.fastest_turn < bounds.turn);
      CHECK(speeds.largest_tilt < bounds.tilt);
      CHECK(speeds.nearest > 0.2);
    }
  }
}

TEST_CASE("a path is smooth: speed changes little from frame to frame") {
  const Scene scene = make_scene("office", 2);
  for (const std::string& name : path_names()) {
    CAPTURE(name);
    const CameraPath path(scene, path_style(name), 2, 10);
    double hardest = 0;
    for (double t = kFrame; t < 10; t += kFrame) {
      const auto at = [&](double seconds) {
        return path.world_to_camera(seconds).inverse().translation().eval();
      };
      hardest = std::max(hardest, (at(t + kFrame) - 2 * at(t) + at(t - kFrame)).norm() / (kFrame * kFrame));
    }
    CHECK(hardest < 2.5);  // metres a second squared
  }
}

TEST_CASE("a loop comes back to where it began") {
  for (const std::string& name : scene_names()) {
    CAPTURE(name);
    const Scene scene = make_scene(name, 1);
    const CameraPath path(scene, path_style("loop"), 1, 200);
    const double lap = path.lap_seconds();
    CHECK(lap > 5);
    CHECK(lap < 190);
    const Pose start = path.world_to_camera(0).inverse(), end = path.world_to_camera(lap).inverse();
    CHECK((start.translation() - end.translation()).norm() < 0.3);
    CHECK(Eigen::AngleAxisd(start.linear().transpose() * end.linear()).angle() < 0.2);
  }
}

TEST_CASE("a turn sees all around in 250 frames, from a circle of half a metre") {
  for (const std::string& name : scene_names()) {
    CAPTURE(name);
    const CameraPath path(make_scene(name, 1), path_style("turn"), 1, 250 / 30.0);
    double turned = 0;
    Vector3d low = Vector3d::Constant(1e9), high = -low, outwards = Vector3d::Zero(),
             centre = Vector3d::Zero();
    for (int i = 0; i < 250; ++i) {
      const Pose now = path.world_to_camera(i / 30.0).inverse();
      const Pose next = path.world_to_camera((i + 1) / 30.0).inverse();
      const Vector3d a = now.linear().col(2), b = next.linear().col(2);
      turned += std::atan2(a.x() * b.y() - a.y() * b.x(), a.head<2>().dot(b.head<2>()));
      low = low.cwiseMin(now.translation());
      high = high.cwiseMax(now.translation());
      centre += now.translation() / 250;
      if (i == 0) outwards = now.translation();
    }
    CHECK(turned * 180 / std::numbers::pi == doctest::Approx(370).epsilon(0.01));
    CHECK((high - low).x() == doctest::Approx(1).epsilon(0.03));
    CHECK((high - low).y() == doctest::Approx(1).epsilon(0.03));
    // It looks away from the middle.
    CHECK((outwards - centre).dot(path.world_to_camera(0).inverse().linear().col(2)) > 0.4);
  }
}

TEST_CASE("the seed chooses the path, and nothing else does") {
  const Scene scene = make_scene("office", 1);
  const CameraPath first(scene, path_style("handheld"), 1, 5), again(scene, path_style("handheld"), 1, 5);
  const CameraPath other(scene, path_style("handheld"), 2, 5);
  CHECK(first.world_to_camera(2).matrix() == again.world_to_camera(2).matrix());
  CHECK((first.world_to_camera(2).inverse().translation() - other.world_to_camera(2).inverse().translation())
            .norm() > 0.01);
}

TEST_CASE("a scene without room and an unknown path are refused") {
  Scene scene = make_scene("office", 1);
  for (Waypoint& stop : scene.circuit) stop.position.z() = 0.5 * 0.7;
  CHECK_THROWS_AS(CameraPath(scene, path_style("handheld"), 1, 60), InputError);
  CHECK_THROWS_AS(path_style("teleport"), InputError);
}
