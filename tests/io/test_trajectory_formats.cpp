#include "engine/io/trajectory_formats.h"

#include <algorithm>
#include <cmath>

#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;
using test::input_error;
using test::TemporaryFolder;

namespace {

TrajectoryFile read_text(const TemporaryFolder& folder, const std::string& text,
                         const TrajectoryReading& reading = {}) {
  return read_any_trajectory(folder.write("poses.txt", text), reading);
}

/// Whether a pose stands at x, y, z and leads its camera's forward axis to the world's axis `forward`.
bool looks(const StampedPose& pose, const Eigen::Vector3d& position, const Eigen::Vector3d& forward) {
  return pose.camera_to_world.translation().isApprox(position, 1e-9) &&
         (pose.camera_to_world.linear() * Eigen::Vector3d::UnitZ()).isApprox(forward, 1e-6);
}

const Eigen::Vector3d kPosition(1, 2, 3);
const Eigen::Vector3d kRight =
    Eigen::Vector3d::UnitX();  ///< where a camera turned by 90 degrees about y looks
const std::string kHalf = "0.70710678118654752";
const std::string kTurned = "0 " + kHalf + " 0 " + kHalf;  ///< that turn, as x y z w

}  // namespace

TEST_CASE("TUM's format is known with header rows, commas and semicolons, and with RTAB-Map's ninth column") {
  const TemporaryFolder folder;
  const std::string pose = "1.5 1 2 3 " + kTurned;
  std::string commas = pose, semicolons = pose;
  std::replace(commas.begin(), commas.end(), ' ', ',');
  std::replace(semicolons.begin(), semicolons.end(), ' ', ';');
  for (const std::string& text :
       {pose + "\n", "timestamp tx ty tz qx qy qz qw\n" + pose + "\n",
        "# made by a program\n\n" + pose + "  \n", "time,x,y,z,qx,qy,qz,qw\n" + commas + "\n",
        semicolons + "\n", commas + ",\n", "#timestamp x y z qx qy qz qw id\n" + pose + " 7\n",
        "# ok\r\n" + pose + "\r\n"}) {
    CAPTURE(text);
    const TrajectoryFile file = read_text(folder, text);
    CHECK(file.format == TrajectoryFormat::Tum);
    CHECK_FALSE(file.numbered);
    REQUIRE(file.poses.size() == 1);
    CHECK(file.poses[0].timestamp == 1.5);
    CHECK(looks(file.poses[0], kPosition, kRight));
  }
  CHECK(read_text(folder, "1 2 3 " + kTurned + "\n").numbered);
}

TEST_CASE("EuRoC's tables have nanoseconds, and their quaternions begin with w") {
  const TemporaryFolder folder;
  const std::string pose = "1403636580838555648,1,2,3," + kHalf + ",0," + kHalf + ",0";
  const std::string header =
      "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []";
  for (const std::string& text :
       {header + ", v_RS_R_x [m s^-1]\n" + pose + ",0.5,0,0,0,0,0,0,0,0\n", header + "\n" + pose + "\n",
        pose + "\n", "timestamp,tx,ty,tz,qw,qx,qy,qz\n" + pose + "\n"}) {
    CAPTURE(text);
    const TrajectoryFile file = read_text(folder, text);
    CHECK(file.format == TrajectoryFormat::Euroc);
    REQUIRE(file.poses.size() == 1);
    CHECK(std::abs(file.poses[0].timestamp - 1403636580.838555648) < 1e-6);
    CHECK(looks(file.poses[0], kPosition, kRight));
  }
  // ORB-SLAM3 writes nanoseconds with blanks between, and the quaternion as TUM's.
  const TrajectoryFile orb = read_text(folder, "1403636580838555648.000000 1 2 3 " + kTurned + "\n");
  CHECK(orb.format == TrajectoryFormat::Tum);
  CHECK(std::abs(orb.poses[0].timestamp - 1403636580.838555648) < 1e-6);
  CHECK(looks(orb.poses[0], kPosition, kRight));
}

TEST_CASE("clocks that count from nought in nano- or microseconds are told by their steps") {
  const TemporaryFolder folder;
  const auto last = [&](const std::string& step, const std::string& twice) {
    const std::string rest = " 0 0 0 0 0 0 1\n";
    return read_text(folder, "0" + rest + step + rest + twice + rest).poses.back().timestamp;
  };
  CHECK(last("50000000", "100000000") == doctest::Approx(0.1));
  CHECK(last("50000", "100000") == doctest::Approx(0.1));
  CHECK(last("0.05", "0.1") == doctest::Approx(0.1));
  CHECK(last("1", "2") == 2);
}

TEST_CASE("KITTI's rows are numbered, or get the stamps of frames where they are as many") {
  const TemporaryFolder folder;
  const std::string row = "0 0 1 1 0 1 0 2 -1 0 0 3\n";
  const TrajectoryFile file = read_text(folder, row + row);
  CHECK(file.format == TrajectoryFormat::Kitti);
  CHECK(file.numbered);
  REQUIRE(file.poses.size() == 2);
  CHECK(file.poses[1].timestamp == 1);
  CHECK(looks(file.poses[1], kPosition, kRight));

  const TrajectoryFile stamped = read_text(folder, row + row, {.stamps = {5.25, 5.5}});
  CHECK_FALSE(stamped.numbered);
  CHECK(stamped.poses[1].timestamp == 5.5);
  CHECK(contains(input_error([&] {
                   read_text(folder, row + row, {.stamps = {1, 2, 3}});
                 }),
                 "has 2 poses without stamps for 3 frames"));
  CHECK(contains(input_error([&] { read_text(folder, row + "0 0 9 1 0 1 0 2 -1 0 0 3\n"); }),
                 "poses.txt:2: is no rigid transform"));
}

TEST_CASE("matrices: sixteen numbers a row, a stamp before them, or four lines as in Redwood's logs") {
  const TemporaryFolder folder;
  const std::string row = "0 0 1 1 0 1 0 2 -1 0 0 3 0 0 0 1", lines = "0 0 1 1\n0 1 0 2\n-1 0 0 3\n0 0 0 1\n";
  for (const std::string& text :
       {row + "\n" + row + "\n", lines + "\n" + lines, "0 0 1\n" + lines + "1 1 2\n" + lines}) {
    CAPTURE(text);
    const TrajectoryFile file = read_text(folder, text);
    CHECK(file.format == TrajectoryFormat::Matrices);
    CHECK(file.numbered);
    REQUIRE(file.poses.size() == 2);
    CHECK(looks(file.poses[1], kPosition, kRight));
  }
  for (const std::string& text : {"7.5 " + row + "\n", std::string("7.5 0 0 1 1 0 1 0 2 -1 0 0 3\n")}) {
    const TrajectoryFile file = read_text(folder, text);
    CHECK_FALSE(file.numbered);
    CHECK(file.poses[0].timestamp == 7.5);
    CHECK(looks(file.poses[0], kPosition, kRight));
  }
  CHECK_FALSE(read_text(folder, "-inf -inf -inf -inf -inf -inf -inf -inf -inf -inf -inf -inf 0 0 0 1\n")
                  .poses[0]
                  .is_finite());
  CHECK(contains(input_error([&] { read_text(folder, "0 0 1 1\n0 1 0 2\n"); }), "ends within a matrix"));
}

TEST_CASE("Bundler's cameras look along -z with y up, and are stored from world to camera") {
  const TemporaryFolder folder;
  // R turns the world into the camera: its rows are the camera's right, up and back in the world. The camera
  // stands at (1, 2, 3), looks along x with y up: right is z, back is -x; t = -R c.
  const std::string camera = "500 0 0\n0 0 1\n0 1 0\n-1 0 0\n-3 -2 1\n";
  const std::string lost = "0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n";
  const TrajectoryFile file =
      read_text(folder, "# Bundle file v0.3\n2 1\n" + camera + lost + "1 1 1\n255 0 0\n0\n");
  CHECK(file.format == TrajectoryFormat::Bundler);
  CHECK(file.numbered);
  REQUIRE(file.poses.size() == 2);
  CHECK(looks(file.poses[0], kPosition, kRight));
  CHECK((file.poses[0].camera_to_world.linear() * Eigen::Vector3d::UnitY())
            .isApprox(-Eigen::Vector3d::UnitY()));
  CHECK_FALSE(file.poses[1].is_finite());
  CHECK(read_text(folder, "1 0\n" + camera, {.format = TrajectoryFormat::Bundler}).poses.size() == 1);
  CHECK(contains(input_error([&] { read_text(folder, "# Bundle file v0.3\n4000000000 0\n" + camera); }),
                 "names 4e+09 cameras, there are lines for 1"));
}

TEST_CASE("transforms.json: cameras that look along -z with y up, in the order of their images' numbers") {
  const TemporaryFolder folder;
  const auto frame = [](const std::string& name, const std::string& x) {
    return R"({"file_path": ")" + name + R"(", "transform_matrix": [[0, 0, -1, )" + x +
           "], [0, 1, 0, 2], [1, 0, 0, 3], [0, 0, 0, 1]]}";
  };
  const TrajectoryFile file =
      read_text(folder, R"({"fl_x": 500, "frames": [)" + frame("images/frame_10.png", "9") + "," +
                            frame("images/frame_9.png", "1") + "]}");
  CHECK(file.format == TrajectoryFormat::Transforms);
  CHECK(file.numbered);
  REQUIRE(file.poses.size() == 2);
  CHECK(looks(file.poses[0], kPosition, kRight));
  CHECK(file.poses[1].camera_to_world.translation().x() == 9);
  CHECK(contains(input_error([&] { read_text(folder, R"({"frames": [{"file_path": "a"}]})"); }),
                 "transform_matrix"));
  CHECK(contains(input_error([&] { read_text(folder, R"({"frames": []})"); }), "holds no pose"));
}

TEST_CASE("what is no trajectory is named, with the line and what is known") {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& text) { return input_error([&] { read_text(folder, text); }); };
  CHECK(contains(error(""), "poses.txt: holds no pose"));
  CHECK(contains(error("timestamp tx ty tz qx qy qz qw\n"), "holds no pose"));
  CHECK(contains(error("1 2 3 4 5\n"), "poses.txt:1: has 5 numbers; of trajectories are known: 8 or 9"));
  CHECK(contains(error("1 0 0 0 0 0 0 1\n2 0 0\n"), "poses.txt:2: has 3 numbers, but the first row has 8"));
  CHECK(contains(error("a 0 0 0 0 0 0 1\n"), "poses.txt:1: \"a 0 0 0 0 0 0 1\" are no numbers"));
  CHECK(contains(error("1 0 0 0 0 0 0 1\nname of a column\n"), "poses.txt:2:"));
  CHECK(contains(error("nan 0 0 0 0 0 0 1\n"), "poses.txt:1: its time stamp is no number"));
  CHECK(contains(error("1 0 0 0 0 0 0 0\n"), "poses.txt:1: the quaternion"));
  CHECK(contains(input_error([&] { read_any_trajectory(folder / "none.txt"); }), "none.txt: no such file"));
  CHECK(contains(
      input_error([&] { read_text(folder, "1 0 0 0 0 0 0 1\n", {.format = TrajectoryFormat::Kitti}); }),
      "poses.txt:1: has 8 numbers; the format kitti wants 12"));
}

TEST_CASE("a format that is asked for decides where the content does not tell") {
  const TemporaryFolder folder;
  const std::string row = "1.5 1 2 3 " + kHalf + " 0 " + kHalf + " 0\n";  // w x y z, unmarked
  CHECK(read_text(folder, row).format == TrajectoryFormat::Tum);
  const TrajectoryFile file = read_text(folder, row, {.format = TrajectoryFormat::Euroc});
  CHECK(looks(file.poses[0], kPosition, kRight));
}

TEST_CASE("stamps are read from times.txt, from TUM's lists and from trajectories") {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& text) { return read_stamps(folder.write("times.txt", text)); };
  CHECK(read("0.5\n1.5\n") == std::vector<double>{0.5, 1.5});
  CHECK(read("# rgb\n0.5 rgb/0.5.png\n1.5 rgb/1.5.png\n") == std::vector<double>{0.5, 1.5});
  CHECK(contains(input_error([&] { read("0.5\nrgb/a.png\n"); }),
                 "times.txt:2: does not begin with a time stamp"));
  CHECK(contains(input_error([&] { read("# none\n"); }), "holds no time stamp"));
}

TEST_CASE("a trajectory of any format cut at any byte is read or refused, never a crash") {
  const TemporaryFolder folder;
  const std::vector<std::string> files = {
      "# a b\n1.5,1,2,3," + kHalf + ",0," + kHalf + ",0\n", "0 0 1 1 0 1 0 2 -1 0 0 3\n",
      "# Bundle file v0.3\n1 0\n500 0 0\n0 0 1\n0 1 0\n-1 0 0\n-3 -2 1\n",
      R"({"frames": [{"file_path": "9", "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}]})",
      "0 0 1\n0 0 1 1\n0 1 0 2\n-1 0 0 3\n0 0 0 1\n"};
  for (const std::string& full : files) {
    for (std::size_t length = 0; length <= full.size(); ++length) {
      std::size_t poses = 0;
      const std::string message =
          input_error([&] { poses = read_text(folder, full.substr(0, length)).poses.size(); });
      CHECK((poses == 1 || contains(message, "poses.txt")));
    }
  }
}
