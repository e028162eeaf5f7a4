#include "engine/types/trajectory.h"

#include <cmath>
#include <limits>

#include "engine/io/files.h"
#include "engine/io/trajectory_file.h"
#include "engine/io/trajectory_formats.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;
using test::input_error;
using test::TemporaryFolder;

namespace {

StampedPose make_pose(double timestamp, double angle, const Eigen::Vector3d& position) {
  StampedPose pose;
  pose.timestamp = timestamp;
  pose.camera_to_world.linear() =
      Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  pose.camera_to_world.translation() = position;
  return pose;
}

Trajectory read_text(const TemporaryFolder& folder, const std::string& text) {
  return read_trajectory(folder.write("trajectory.txt", text));
}

}  // namespace

TEST_CASE("a known line gives a known pose, comments and blanks are skipped, quaternions are normalised") {
  const TemporaryFolder folder;
  // A quarter turn about z, with a quaternion of length 2.
  const std::string half = "1.4142135623730951";
  const Trajectory trajectory =
      read_text(folder, "# stamp tx ...\n\n  1.5 1 2 3 0 0 " + half + " " + half + "  \r\n# end\n");
  REQUIRE(trajectory.size() == 1);
  CHECK(trajectory[0].timestamp == 1.5);
  const Eigen::Vector3d moved = trajectory[0].camera_to_world * Eigen::Vector3d::UnitX();
  CHECK((moved - Eigen::Vector3d(1, 3, 3)).norm() < 1e-12);
}

TEST_CASE("poses survive writing and reading, and the bytes are always the same") {
  const TemporaryFolder folder;
  Trajectory trajectory;
  for (int i = 0; i < 50; ++i) {
    trajectory.push_back(
        make_pose(1305031102.175304 + 0.033 * i, -3 + 0.13 * i, {0.1 * i, -1.0 / (i + 1), 0}));
  }
  write_trajectory(folder / "a.txt", trajectory);
  const Trajectory read = read_trajectory(folder / "a.txt");
  REQUIRE(read.size() == trajectory.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    CHECK(std::abs(read[i].timestamp - trajectory[i].timestamp) < 1e-6);
    CHECK(read[i].camera_to_world.isApprox(trajectory[i].camera_to_world, 1e-8));
  }
  write_trajectory(folder / "b.txt", trajectory);
  CHECK(read_file(folder / "a.txt") == read_file(folder / "b.txt"));
}

TEST_CASE("the written form is fixed: digits, sign of the quaternion, no negative zero") {
  const TemporaryFolder folder;
  StampedPose pose = make_pose(2, 0, {-0.0, 1.0 / 3, -2});
  write_trajectory(folder / "a.txt", {pose});
  CHECK(read_file(folder / "a.txt") ==
        "# timestamp tx ty tz qx qy qz qw\n2.000000 0 0.333333333 -2 0 0 0 1\n");
}

TEST_CASE("an unknown pose is kept as one that is not finite") {
  const TemporaryFolder folder;
  const Trajectory trajectory =
      read_text(folder, "1 -inf 0 0 0 0 0 1\n2 0 0 0 nan nan nan nan\n3 0 0 0 0 0 0 1\n");
  REQUIRE(trajectory.size() == 3);
  CHECK_FALSE(trajectory[0].is_finite());
  CHECK_FALSE(trajectory[1].is_finite());
  CHECK(trajectory[2].is_finite());
  write_trajectory(folder / "again.txt", trajectory);
  CHECK_FALSE(read_trajectory(folder / "again.txt")[0].is_finite());
}

TEST_CASE("lines that are wrong are named") {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& text) { return input_error([&] { read_text(folder, text); }); };
  for (const char* line : {"1 2 3", "1 0 0 0 0 0 0 1 9", "a 0 0 0 0 0 0 1", "nan 0 0 0 0 0 0 1"}) {
    CHECK(contains(error(std::string("# ok\n") + line + "\n"), "trajectory.txt:2: expected"));
  }
  CHECK(contains(error("1 0 0 0 0 0 0 0\n"), "trajectory.txt:1: the quaternion"));
  CHECK(contains(input_error([&] { read_trajectory(folder / "none.txt"); }), "none.txt: no such file"));
  CHECK(contains(input_error([&] { write_trajectory(folder / "no/such/t.txt", {}); }), "create it first"));
}

TEST_CASE("a trajectory cut at any byte is read or refused, never a crash") {
  const TemporaryFolder folder;
  write_trajectory(folder / "full.txt", {make_pose(1, 1, {1, 2, 3}), make_pose(2, -1, {-4, 5e-7, 6e8})});
  const std::string full = read_file(folder / "full.txt");
  for (std::size_t length = 0; length <= full.size(); ++length) {
    std::size_t poses = 0;
    const std::string message =
        input_error([&] { poses = read_text(folder, full.substr(0, length)).size(); });
    CHECK(poses <= 2);
    CHECK((message.empty() || contains(message, "trajectory.txt:")));
  }
}

TEST_CASE("a lost frame is marked by a comment before its line, which is read again") {
  const TemporaryFolder folder;
  Trajectory trajectory;
  for (int i = 0; i < 4; ++i) trajectory.push_back(make_pose(i, 0.1 * i, {0.1 * i, 0, 0}));
  trajectory[1].lost = trajectory[2].lost = true;
  write_trajectory(folder / "a.txt", trajectory);
  const std::string text = read_file(folder / "a.txt");
  CHECK(contains(text, "\n# lost\n1.000000 "));
  CHECK(contains(text, "\n# lost\n2.000000 "));
  for (const Trajectory& read :
       {read_trajectory(folder / "a.txt"), read_any_trajectory(folder / "a.txt").poses}) {
    REQUIRE(read.size() == 4);
    for (int i = 0; i < 4; ++i) CHECK(read[i].lost == trajectory[i].lost);
  }
  // Other comments say nothing of the pose.
  CHECK_FALSE(read_text(folder, "# lost and found\n0 0 0 0 0 0 0 1\n")[0].lost);
  CHECK_FALSE(read_text(folder, "# lost\n\n0 0 0 0 0 0 0 1\n")[0].lost);
}
