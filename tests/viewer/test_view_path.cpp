#include <cmath>
#include <random>

#include "engine/types/error.h"
#include "engine/viewer/follower.h"
#include "engine/viewer/view_path.h"
#include "tests/support/input_files.h"

using namespace surefield;
using namespace surefield::test;

namespace {

constexpr double kRight = M_PI / 2;

Pose pose_of(const Eigen::Vector3d& place, double angle,
             const Eigen::Vector3d& axis = Eigen::Vector3d::UnitY()) {
  Pose pose = Pose::Identity();
  pose.translate(place).rotate(Eigen::AngleAxisd(angle, axis));
  return pose;
}

Trajectory random_keys(uint32_t seed, int count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-1, 1);
  Trajectory keys;
  double time = -3;
  for (int i = 0; i < count; ++i) {
    time += 0.2 + std::abs(value(random));
    const Eigen::Vector3d axis(value(random), value(random), value(random));
    keys.push_back(
        {time, pose_of({value(random), value(random), value(random)}, 3 * value(random), axis.normalized())});
  }
  return keys;
}

/// Unevenly scattered, with a few far away.
GaussianCloud scattered_map() {
  GaussianCloud map;
  std::mt19937 random(3);
  std::normal_distribution<float> value(0, 1);
  map.resize(505);
  map.sh.assign(3 * 505, 0);
  for (int i = 0; i < 505; ++i) {
    map.opacity_logits[i] = i < 500 ? 2.0f : 5.0f;
    map.means[i] = i < 500 ? Eigen::Vector3f(1 + value(random), 2 + 0.5f * value(random), 5 + value(random))
                           : Eigen::Vector3f(500, 500, -900);
  }
  return map;
}

Trajectory follow(const Trajectory& tracked) {
  Follower follower;
  Trajectory poses;
  for (const StampedPose& pose : tracked)
    poses.push_back({pose.timestamp, follower.follow(pose.camera_to_world)});
  return poses;
}

}  // namespace

TEST_CASE("a path goes exactly through its keys, and stays at its ends before and after them") {
  const Trajectory keys = random_keys(1, 7);
  const ViewPath path(keys);
  for (const StampedPose& key : keys)
    CHECK(path.camera_to_world(key.timestamp).isApprox(key.camera_to_world, 1e-9));
  CHECK(path.begin() == keys.front().timestamp);
  CHECK(path.end() == keys.back().timestamp);
  CHECK(path.camera_to_world(path.begin() - 5).isApprox(keys.front().camera_to_world));
  CHECK(path.camera_to_world(path.end() + 5).isApprox(keys.back().camera_to_world));
}

TEST_CASE("between two keys a path is straight and turns evenly") {
  const ViewPath path({{1, pose_of({0, 0, 0}, 0)}, {3, pose_of({4, -2, 0}, kRight)}});
  for (double share : {0.25, 0.5, 0.8}) {
    const Pose expected = pose_of({4 * share, -2 * share, 0}, share * kRight);
    CHECK(path.camera_to_world(1 + 2 * share).isApprox(expected, 1e-9));
  }
}

TEST_CASE("midway between evenly spaced keys a path is where Catmull and Rom put it") {
  // (-p0 + 9 p1 + 9 p2 - p3) / 16, for places and, about one axis, for angles.
  const double places[] = {0, 1, 5, 4}, angles[] = {0.1, 0.4, 1.2, 0.9};
  Trajectory keys;
  for (int i = 0; i < 4; ++i) keys.push_back({0.5 * i, pose_of({0, places[i], 2}, angles[i])});
  const auto middle = [](const double* p) { return (-p[0] + 9 * p[1] + 9 * p[2] - p[3]) / 16; };
  const Pose pose = ViewPath(keys).camera_to_world(0.75);
  CHECK(pose.isApprox(pose_of({0, middle(places), 2}, middle(angles)), 1e-9));
}

TEST_CASE("a path has no corners, no jumps of its speed, and rotations that are rotations") {
  const Trajectory keys = random_keys(5, 9);
  const ViewPath path(keys);
  const double h = 1e-5;
  const auto speed = [&](double from, double to) -> Eigen::Matrix4d {
    return (path.camera_to_world(to).matrix() - path.camera_to_world(from).matrix()) / h;
  };
  for (std::size_t i = 1; i + 1 < keys.size(); ++i) {
    const double time = keys[i].timestamp;
    CHECK((speed(time - h, time) - speed(time, time + h)).norm() < 0.01);
    CHECK(speed(time - h, time).norm() > 0.1);
  }
  for (double time = path.begin(); time < path.end(); time += 0.05) {
    const Eigen::Matrix3d rotation = path.camera_to_world(time).linear();
    CHECK((rotation * rotation.transpose()).isIdentity(1e-12));
    CHECK(rotation.determinant() == doctest::Approx(1));
  }
}

TEST_CASE("a path takes the shorter way round, whatever the signs of quaternions") {
  const ViewPath path({{0, pose_of({0, 0, 0}, 3.0)}, {1, pose_of({0, 0, 0}, -3.0)}});
  CHECK(path.camera_to_world(0.5).isApprox(pose_of({0, 0, 0}, M_PI), 1e-9));
}

TEST_CASE("a path refuses keys without order, and none at all") {
  CHECK_THROWS_AS(ViewPath({}), UsageError);
  CHECK_THROWS_AS(ViewPath({{1, Pose::Identity()}, {1, Pose::Identity()}}), UsageError);
  Pose unknown = Pose::Identity();
  unknown.translation().x() = NAN;
  CHECK_THROWS_AS(ViewPath({{1, unknown}}), UsageError);
  CHECK(ViewPath({{1, pose_of({1, 2, 3}, 1)}}).camera_to_world(7).isApprox(pose_of({1, 2, 3}, 1)));
}

TEST_CASE("a camera that looks at a point has it in its middle, and up upwards") {
  const Eigen::Vector3d from(1, -2, 0.5), at(3, 1, 4), up(0.1, -1, 0.2);
  const Pose to_camera = look_at(from, at, up).inverse();
  CHECK((to_camera * from).norm() < 1e-12);
  CHECK((to_camera * at).isApprox(Eigen::Vector3d(0, 0, (at - from).norm())));
  const Eigen::Vector3d above = to_camera.linear() * up;
  CHECK(above.y() < 0);
  CHECK(std::abs(above.x()) < 1e-12);
  CHECK(to_camera.linear().determinant() == doctest::Approx(1));
  // Straight up, any side may be right.
  const Pose straight = look_at(from, from + up, up);
  CHECK(straight.linear().determinant() == doctest::Approx(1));
  CHECK(straight.linear().col(2).isApprox(up.normalized()));
}

TEST_CASE("an orbit goes once around the middle of the map and looks at it") {
  const GaussianCloud map = scattered_map();
  const Intrinsics lens{.width = 320, .height = 180, .fx = 200, .fy = 200, .cx = 159.5, .cy = 89.5};
  const Eigen::Vector3d up(0, -1, 0), middle = middle_of(map, up);
  CHECK((middle - Eigen::Vector3d(1, 2, 5)).norm() < 0.2);
  const ViewPath path = orbit(map, lens, up, 6);
  CHECK(path.begin() == 0);
  CHECK(path.end() == 6);
  CHECK(path.camera_to_world(0).isApprox(path.camera_to_world(6), 1e-9));
  int least_shown = 505;
  for (double time = 0; time < 6; time += 0.13) {
    const Pose to_camera = path.camera_to_world(time).inverse();
    const Eigen::Vector3d seen = to_camera * middle;
    CHECK(seen.head<2>().norm() < 1e-3 * seen.z());
    CHECK(seen.z() > 0);
    CHECK((to_camera.linear() * up).y() < -0.8);
    // From above, the camera is higher.
    CHECK((path.camera_to_world(time).translation() - middle).dot(up) > 0);
    int shown = 0;
    for (const Eigen::Vector3f& mean : map.means) {
      const Eigen::Vector3d p = to_camera * mean.cast<double>();
      shown += p.z() > 0 && std::abs(p.x() / p.z()) < 0.8 && std::abs(p.y() / p.z()) < 0.45;
    }
    CHECK(shown > 475);
    least_shown = std::min(least_shown, shown);
  }
  // And no farther off than that needs.
  CHECK(least_shown < 490);
  // A quarter of the way it has come a quarter round.
  const Eigen::Vector3d start = path.camera_to_world(0).translation() - middle;
  const Eigen::Vector3d quarter = path.camera_to_world(1.5).translation() - middle;
  CHECK(std::abs((start - start.dot(up) * up).dot(quarter - quarter.dot(up) * up)) < 1e-3);
}

TEST_CASE("an orbit comes nearer where a map is narrow, without jerks") {
  GaussianCloud map = scattered_map();
  for (int i = 0; i < 500; ++i) map.means[i].x() = 1 + 4 * (map.means[i].x() - 1);
  const Intrinsics lens{.width = 320, .height = 180, .fx = 200, .fy = 200, .cx = 159.5, .cy = 89.5};
  const Eigen::Vector3d up(0, -1, 0), middle = middle_of(map, up);
  const ViewPath path = orbit(map, lens, up, 4);
  const auto distance = [&](double time) {
    return (path.camera_to_world(time).translation() - middle).norm();
  };
  double least = INFINITY, most = 0;
  for (double time = 0; time < 4; time += 0.05) {
    least = std::min(least, distance(time));
    most = std::max(most, distance(time));
    CHECK(std::abs(distance(time + 0.05) - distance(time)) < 0.05 * distance(time));
  }
  CHECK(least < 0.9 * most);
}

TEST_CASE("an orbit of an empty map is none that fails") {
  CHECK(orbit({}, {.width = 4, .height = 4, .fx = 4, .fy = 4}, {0, -1, 0}, 1)
            .camera_to_world(0.3)
            .matrix()
            .allFinite());
}

TEST_CASE("up is what the cameras have above them on average") {
  Trajectory cameras = {{0, pose_of({0, 0, 0}, 0.3, {1, 0, 0})}, {1, pose_of({0, 0, 0}, -0.3, {1, 0, 0})}};
  CHECK(up_of(cameras).isApprox(Eigen::Vector3d(0, -1, 0)));
  cameras = {{0, pose_of({0, 0, 0}, kRight, {0, 0, 1})}};
  CHECK(up_of(cameras).isApprox(Eigen::Vector3d(1, 0, 0), 1e-9));
  CHECK(up_of({}).isApprox(Eigen::Vector3d(0, -1, 0)));
}

TEST_CASE("a follower is behind and above the camera, has it in view, and looks where it looks") {
  Trajectory still;
  for (int i = 0; i < 5; ++i) still.push_back({double(i), pose_of({1, 2, 3}, 0.7)});
  const Trajectory followers = follow(still);
  REQUIRE(followers.size() == 5);
  for (const StampedPose& follower : followers) {
    CHECK(follower.camera_to_world.isApprox(followers[0].camera_to_world, 1e-9));
    const Eigen::Vector3d seen = still[0].camera_to_world.inverse() * follower.camera_to_world.translation();
    CHECK(seen.z() < -0.3);
    CHECK(seen.y() < -0.1);
    const Eigen::Vector3d camera =
        follower.camera_to_world.inverse() * still[0].camera_to_world.translation();
    CHECK(camera.z() > 0.3);
    CHECK(std::abs(camera.x()) < 1e-9);
    CHECK(camera.y() / camera.z() < 0.4);
    CHECK(follower.camera_to_world.linear().col(2).dot(still[0].camera_to_world.linear().col(2)) > 0.9);
  }
}

TEST_CASE("a follower is never in the camera, and moves more smoothly than it does") {
  // Forth, suddenly back at two metres a second through where the follower is, round and forth, shaking.
  Trajectory cameras;
  std::mt19937 random(8);
  std::normal_distribution<double> shake(0, 0.02);
  double z = 0;
  for (int i = 0; i < 300; ++i) {
    z += (i < 100 || i > 200 ? 0.03 : -0.07);
    const double angle = i < 150 ? 0 : std::min(M_PI, 0.3 * (i - 150));
    cameras.push_back({i / 30.0, pose_of({shake(random), shake(random), z + shake(random)}, angle)});
  }
  const Trajectory followers = follow(cameras);
  REQUIRE(followers.size() == cameras.size());
  double camera_jerks = 0, follower_jerks = 0;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const auto place = [i](const Trajectory& t, std::size_t back) {
      return t[i - back].camera_to_world.translation();
    };
    CHECK((place(followers, 0) - place(cameras, 0)).norm() >= Follower::kNearest - 1e-9);
    if (i < 2 || i > 100) continue;
    camera_jerks += (place(cameras, 0) - 2 * place(cameras, 1) + place(cameras, 2)).norm();
    follower_jerks += (place(followers, 0) - 2 * place(followers, 1) + place(followers, 2)).norm();
  }
  CHECK(follower_jerks < 0.1 * camera_jerks);
}

TEST_CASE("a path file has keys of both kinds, and says what is wrong with it") {
  const TemporaryFolder folder;
  const std::string lens = R"({"width": 64, "height": 48, "fx": 50, "fy": 51, "cx": 32, "cy": 24, "keys": )";
  const std::string pose = R"({"time": 0, "world_to_camera": [[1,0,0,-1],[0,1,0,-2],[0,0,1,-3],[0,0,0,1]]})";
  const auto read = [&](const std::string& keys) {
    return read_view_path(folder.write("path.json", lens + keys + "}"));
  };
  const RecordedViewPath path =
      read("[" + pose + R"(, {"time": 2.5, "position": [0, 0, 0], "look_at": [0, 0, 4]},
        {"time": 3, "position": [0, 0, 0], "look_at": [0, 0, 4], "up": [1, 0, 0]}])");
  CHECK(path.intrinsics.fy == 51);
  CHECK(path.path.begin() == 0);
  CHECK(path.path.end() == 3);
  CHECK(path.path.camera_to_world(0).isApprox(pose_of({1, 2, 3}, 0)));
  CHECK(path.path.camera_to_world(2.5).isApprox(Pose::Identity(), 1e-9));
  CHECK(path.path.camera_to_world(3).linear().col(1).isApprox(Eigen::Vector3d(-1, 0, 0), 1e-9));

  const auto error = [&](const std::string& keys) { return input_error([&] { read(keys); }); };
  CHECK(contains(error("[" + pose + "]"), "\"keys\" must hold two keys at least"));
  CHECK(contains(error("[" + pose + ", " + pose + "]"), "\"time\" must be later"));
  CHECK(contains(error("7"), "\"keys\" must be a list of objects"));
  CHECK(contains(error(R"([{"time": 0}])"), "\"position\" and \"look_at\" are missing"));
  CHECK(contains(error(R"([{"time": 0, "position": [1, 2], "look_at": [0, 0, 1]}])"), "three numbers"));
  CHECK(contains(error(R"([{"time": 0, "position": [1, 2, 3], "look_at": [1, 2, 3]}])"), "another point"));
}
