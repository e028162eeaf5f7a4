#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "engine/synth/camera_path.h"
#include "engine/synth/scene_renderer.h"
#include "engine/types/error.h"
#include "tests/support/device.h"

using namespace surefield;
using Eigen::Vector3d;

namespace {

/// Points on the surface of a body: a grid of 5 x 5 on each face of its box, drawn in to round bodies.
std::vector<Vector3d> surface_points(const Shape& shape) {
  std::vector<Vector3d> points;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      for (int i = 0; i < 25; ++i) {
        Vector3d unit;
        unit[axis] = side;
        unit[(axis + 1) % 3] = 0.5 * (i % 5) - 1;
        unit[(axis + 2) % 3] = 0.5 * (i / 5) - 1;
        if (shape.kind == ShapeKind::Ellipsoid) unit.normalize();
        if (shape.kind == ShapeKind::Cylinder && unit.head<2>().norm() > 1) unit.head<2>().normalize();
        points.push_back(shape.shape_to_world * unit.cwiseProduct(shape.half_size));
      }
    }
  }
  return points;
}

/// How deep a point lies in a body, metres; negative outside.
double depth_inside(const Shape& shape, const Vector3d& point) {
  const Vector3d local = shape.shape_to_world.inverse() * point;
  const Vector3d room = shape.half_size - local.cwiseAbs();
  if (shape.kind == ShapeKind::Box) return room.minCoeff();
  const Vector3d unit = local.cwiseQuotient(shape.half_size);
  if (shape.kind == ShapeKind::Ellipsoid) return (1 - unit.norm()) * shape.half_size.minCoeff();
  return std::min(room.z(), (1 - unit.head<2>().norm()) * shape.half_size.x());
}

struct Contact {
  double nearest = 1e9;  ///< metres from the object to another one
  double deepest = -1;   ///< metres that the object reaches into another one
  std::string of_deepest;
};

/// What each object has to do with the others.
std::vector<Contact> contacts(const Scene& scene) {
  std::vector<Contact> all(scene.objects.size());
  for (const Shape& shape : scene.shapes) {
    Contact& contact = all[static_cast<std::size_t>(shape.object)];
    const double reach = shape.half_size.norm() + 0.01;
    for (const Shape& other : scene.shapes) {
      if (other.object == shape.object || other.distance(shape.shape_to_world.translation()) > reach)
        continue;
      for (const Vector3d& point : surface_points(shape)) {
        contact.nearest = std::min(contact.nearest, other.distance(point));
        const double deep = depth_inside(other, point);
        if (deep <= contact.deepest) continue;
        contact.deepest = deep;
        contact.of_deepest = scene.objects[static_cast<std::size_t>(other.object)];
      }
    }
  }
  return all;
}

}  // namespace

TEST_CASE("[slow] nothing floats and nothing stands in something else, with seeds 1 to 3") {
  for (const std::string& name : scene_names()) {
    for (const uint32_t seed : {1u, 2u, 3u}) {
      const Scene scene = make_scene(name, seed);
      const auto all = contacts(scene);
      for (std::size_t i = 0; i < all.size(); ++i) {
        if (scene.objects[i] == "room" || scene.objects[i] == "visitor") continue;
        CAPTURE(name);
        CAPTURE(seed);
        CAPTURE(scene.objects[i]);
        CAPTURE(all[i].of_deepest);
        CHECK(all[i].nearest < 0.004);
        CHECK(all[i].deepest < 0.03);
      }
    }
  }
}

TEST_CASE("the office is large and has forty objects, boxes, balls and cylinders, lamps and thin parts") {
  for (const uint32_t seed : {1u, 2u, 3u}) {
    const Scene office = make_scene("office", seed);
    CHECK(std::count(office.objects.begin(), office.objects.end(), "room") == 1);
    CHECK(office.objects.size() > 40);
    CHECK(office.lights.size() >= 2);
    std::map<ShapeKind, int> kinds;
    int thin = 0;
    Eigen::AlignedBox3d bounds;
    for (const Shape& shape : office.shapes) {
      ++kinds[shape.kind];
      if (shape.half_size.minCoeff() < 0.006 && shape.kind != ShapeKind::Box) ++thin;
      bounds.extend(shape.shape_to_world.translation());
    }
    CHECK(kinds[ShapeKind::Box] > 100);
    CHECK(kinds[ShapeKind::Ellipsoid] > 20);
    CHECK(kinds[ShapeKind::Cylinder] > 50);
    CHECK(thin > 50);
    CHECK(bounds.sizes().x() > 6);
    CHECK(bounds.sizes().y() > 5);
  }
}

TEST_CASE("about a fifth of the frames of the office show the blank wall") {
  for (const uint32_t seed : {1u, 2u, 3u}) {
    const Scene office = make_scene("office", seed);
    const SceneRenderer renderer(testing::device(), office);
    const CameraPath path(office, path_style("handheld"), seed, 40);
    int frames = 0, blank_frames = 0;
    for (double t = 0; t < 40; t += 0.8) {
      const cv::Mat shapes =
          renderer.render(Camera{{40, 30, 34, 34, 19.5, 14.5}, path.world_to_camera(t)}).shapes;
      const auto blank = std::count_if(shapes.begin<int>(), shapes.end<int>(), [&](int shape) {
        const int material = office.shapes[static_cast<std::size_t>(shape)].material;
        return office.materials[static_cast<std::size_t>(material)].is_blank() && material == 0;
      });
      ++frames;
      if (blank > 350) ++blank_frames;  // three tenths of the image
    }
    CAPTURE(seed);
    CHECK(blank_frames >= 0.12 * frames);
    CHECK(blank_frames <= 0.35 * frames);
  }
}

TEST_CASE("rays along the walks always meet something, and colours are neither dark nor burnt out") {
  for (const std::string& name : scene_names()) {
    CAPTURE(name);
    const Scene scene = make_scene(name, 1);
    const SceneRenderer renderer(testing::device(), scene);
    const CameraPath path(scene, path_style("handheld"), 1, 30);
    for (double t = 0; t < 30; t += 3) {
      const SceneImages images =
          renderer.render(Camera{{80, 60, 68, 68, 39.5, 29.5}, path.world_to_camera(t)});
      double nearest = 0, furthest = 0;
      cv::minMaxLoc(images.depth, &nearest, &furthest);
      CHECK(nearest > 0.15);
      CHECK(furthest < 40);
      const cv::Scalar mean = cv::mean(images.colour);
      for (int c = 0; c < 3; ++c) {
        CHECK(mean[c] > 45);
        CHECK(mean[c] < 215);
      }
    }
  }
}

TEST_CASE("the circuits keep away from everything") {
  for (const std::string& name : scene_names()) {
    for (const uint32_t seed : {1u, 2u, 3u}) {
      const Scene scene = make_scene(name, seed);
      CAPTURE(name);
      CAPTURE(seed);
      for (const Waypoint& stop : scene.circuit) CHECK(scene.clearance(stop.position) > 0.35);
    }
  }
}

TEST_CASE("the twins look alike from the same places, but for the things on the second one's table") {
  const Vector3d to_second(5.4, 0, 0);
  for (const uint32_t seed : {1u, 2u}) {
    CAPTURE(seed);
    const Scene twins = make_scene("twins", seed);
    const SceneRenderer renderer(testing::device(), twins);
    const auto from = [&](const Vector3d& at, double angle) {
      Eigen::Isometry3d camera = Eigen::Translation3d(at) * Eigen::AngleAxisd(angle, Vector3d::UnitZ()) *
                                 Eigen::AngleAxisd(-std::numbers::pi / 2 - 0.3, Vector3d::UnitX());
      return renderer.render(Camera{{80, 60, 68, 68, 39.5, 29.5}, camera.inverse()});
    };
    int differing = 0;
    for (int i = 0; i < 8; ++i) {
      if (i == 3 || i == 4) continue;  // through the door, at the corridor
      CAPTURE(i);
      const Vector3d at(1.7, 1.6, 1.45);
      const SceneImages first = from(at, i * std::numbers::pi / 4);
      const SceneImages second = from(at + to_second, i * std::numbers::pi / 4);
      const cv::Mat apart = cv::abs(first.depth - second.depth) > 0.01;
      const double share = cv::countNonZero(apart) / 4800.0;
      CHECK(share < 0.05);
      differing += share > 0.003;
      CHECK(cv::norm(first.colour, second.colour, cv::NORM_L1, apart == 0) < 3.0 * 3 * 4800);
    }
    CHECK(differing >= 1);
    CHECK(differing <= 3);
  }
}

TEST_CASE("walks through the twins visit the first room, then the second, whatever the seed") {
  for (const uint32_t seed : {1u, 2u, 3u}) {
    const CameraPath path(make_scene("twins", seed), path_style("loop"), seed, 80);
    const auto room = [&](double t) {
      const Vector3d at = path.world_to_camera(t).inverse().translation();
      return at.y() < 0 ? 0 : at.x() < 5 ? 1 : 2;
    };
    std::vector<int> rooms;
    for (double t = 0; t < path.lap_seconds(); t += 0.1)
      if (rooms.empty() || rooms.back() != room(t)) rooms.push_back(room(t));
    CHECK(std::count(rooms.begin(), rooms.end(), 1) == 1);
    CHECK(std::find(rooms.begin(), rooms.end(), 1) < std::find(rooms.begin(), rooms.end(), 2));
    CHECK(std::find(rooms.begin(), rooms.end(), 2) != rooms.end());
  }
}

TEST_CASE("an unknown scene is refused with the names of those there are") {
  CHECK_THROWS_WITH_AS(make_scene("spaceship", 1), doctest::Contains("office"), InputError);
}
