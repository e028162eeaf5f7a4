#include <cmath>

#include "engine/io/trajectory_file.h"
#include "engine/types/trajectory.h"
#include "tests/tools/support.h"

using namespace surefield;
using namespace surefield::test;

namespace {

/// The corners of a square in the plane z = 0 with one second between them, alternately raised by `height`.
Trajectory square(double height) {
  Trajectory trajectory;
  for (int i = 0; i < 4; ++i) {
    StampedPose pose;
    pose.timestamp = i;
    const double x = i == 0 || i == 3 ? -1 : 1, y = i < 2 ? -1 : 1, z = i % 2 == 0 ? height : -height;
    pose.camera_to_world.translation() = Eigen::Vector3d(x, y, z);
    trajectory.push_back(pose);
  }
  return trajectory;
}

/// The same seen from another world, as after a rotation and a move of the origin.
Trajectory moved(Trajectory trajectory) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.translate(Eigen::Vector3d(3, -2, 5)).rotate(Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitY()));
  for (StampedPose& pose : trajectory) pose.camera_to_world = motion * pose.camera_to_world;
  return trajectory;
}

}  // namespace

TEST_CASE("eval measures a known error, wherever the trajectory's world lies") {
  const TemporaryFolder folder;
  write_trajectory(folder / "estimate.txt", moved(square(0.05)));
  write_trajectory(folder / "truth.txt", square(0));
  const Outcome outcome =
      surefield_command({"eval", "--trajectory", folder / "estimate.txt", "--ground-truth",
                         folder / "truth.txt", "--json", folder / "errors.json"},
                        folder.path());
  CHECK(outcome.code == 0);
  CHECK(contains(outcome.out, "ATE RMSE         5.000 cm"));
  const nlohmann::json json = read_json(folder / "errors.json");
  CHECK(json["schema"] == "surefield-trajectory");
  CHECK(json["version"] == 1);
  CHECK(json["pairs"] == 4);
  for (const char* key : {"ate_rmse_m", "ate_mean_m", "ate_median_m", "ate_max_m"}) {
    CHECK(json[key].get<double>() == doctest::Approx(0.05).epsilon(1e-6));
  }
  // Every step climbs or descends by 0.1 m that the truth does not have.
  CHECK(json["rpe_translation_rmse_m"].get<double>() == doctest::Approx(0.1).epsilon(1e-6));
  CHECK(json["rpe_rotation_rmse_rad"].get<double>() < 1e-6);
}

TEST_CASE("eval --run finds again what the run found, and needs no more than its folder") {
  const TemporaryFolder folder;
  const Outcome run = surefield_command(short_run(folder / "out"), folder.path());
  REQUIRE_MESSAGE(run.code == 0, run.err);
  const Outcome outcome =
      surefield_command({"eval", "--run", folder / "out", "--json", folder / "out.json"}, folder.path());
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  CHECK(contains(outcome.out, "ATE RMSE"));
  CHECK(contains(outcome.out, "no keyframes     PSNR"));
  CHECK(contains(outcome.out, "tracking "));
  const nlohmann::json metrics = read_json(folder / "out/metrics.json");
  const nlohmann::json json = read_json(folder / "out.json");
  CHECK(json["schema"] == "surefield-evaluation");
  CHECK(json["images"]["held_out"]["frames"] == 1);
  CHECK(json["memory"] == metrics["memory"]);
  // Poses and map went through files of 9 digits and of floats.
  for (const char* key : {"psnr_db", "psnr_same_exposure_db", "ssim", "depth_l1_m"}) {
    CAPTURE(key);
    const double expected = metrics["images"][key];
    CHECK(json["images"][key].get<double>() == doctest::Approx(expected).epsilon(1e-4));
  }
  CHECK(json["trajectory"]["ate_rmse_m"].get<double>() ==
        doctest::Approx(metrics["trajectory"]["ate_rmse_m"].get<double>()).epsilon(1e-4));

  CHECK(contains(
      surefield_command({"eval", "--run", folder / "out", "--dataset", "/no/such"}, folder.path()).err,
      "/no/such"));
  folder.write("out/trajectory.txt", "0 0 0 0 0 0 0 1\n");
  CHECK(contains(surefield_command({"eval", "--run", folder / "out"}, folder.path()).err,
                 "trajectory.txt: has 1 poses, but metrics.json 3 frames"));
}

TEST_CASE("eval renders the map of a run with the depth model of that run") {
  const TemporaryFolder folder;
  std::vector<std::string> arguments = short_run(folder / "out", 2);
  arguments.insert(arguments.end(), {"--set", "depth_model=centre"});
  REQUIRE(surefield_command(arguments, folder.path()).code == 0);
  const auto depth_error = [&] {
    const Outcome outcome =
        surefield_command({"eval", "--run", folder / "out", "--json", folder / "out.json"}, folder.path());
    REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
    return read_json(folder / "out.json")["images"]["depth_l1_m"].get<double>();
  };
  const double expected = read_json(folder / "out/metrics.json")["images"]["depth_l1_m"];
  CHECK(depth_error() == doctest::Approx(expected).epsilon(1e-4));
  folder.write("out/config.yaml", "depth_model: plane\n");
  CHECK(depth_error() != doctest::Approx(expected).epsilon(1e-3));
}

TEST_CASE("eval reads trajectories of other systems: comments, stamps apart from the truth's") {
  const TemporaryFolder folder;
  write_trajectory(folder / "truth.txt", square(0));
  folder.write("other.txt",
               "# timestamp tx ty tz qx qy qz qw\n"
               "0.0121 -1 -1 0.02 0 0 0 1\n1.004 1 -1 -0.02 0 0 0 1\n"
               "2.0 1 1 0.02 0 0 0 1\n2.99 -1 1 -0.02 0 0 0 1\n7 50 0 0 0 0 0 1\n");
  const Outcome outcome = surefield_command(
      {"eval", "--trajectory", folder / "other.txt", "--ground-truth", folder / "truth.txt"}, folder.path());
  CHECK(outcome.code == 0);
  CHECK(contains(outcome.out, "poses compared   4 of 5"));
  CHECK(contains(outcome.out, "ATE RMSE         2.000 cm"));
  CHECK(contains(outcome.out, "RPE per second   4.000 cm"));
}

TEST_CASE("eval names what it cannot compare") {
  const TemporaryFolder folder;
  write_trajectory(folder / "estimate.txt", square(0));
  write_trajectory(folder / "one.txt", {square(0).front()});
  const auto message = [&](const std::string& truth) {
    const Outcome outcome = surefield_command(
        {"eval", "--trajectory", folder / "estimate.txt", "--ground-truth", truth}, folder.path());
    CHECK(outcome.code == 2);
    return outcome.err;
  };
  CHECK(contains(message(folder / "one.txt"), "surefield: error: "));
  CHECK(contains(message("/no/such"), "/no/such: no such file"));
  CHECK(contains(message(folder.path()), "no known dataset layout"));
  CHECK(contains(surefield_command({"eval"}, folder.path()).err, "give --run, or --trajectory"));
  CHECK(contains(surefield_command({"eval", "--run", folder.path()}, folder.path()).err,
                 "is this a folder that surefield run has written?"));
}
