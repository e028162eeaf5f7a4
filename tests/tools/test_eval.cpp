#include <cmath>
#include <fstream>

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

TEST_CASE("eval --loops judges the loops of a run, and says what a table lacks") {
  const TemporaryFolder folder;
  const Outcome run = surefield_command(short_run(folder / "out"), folder.path());
  REQUIRE_MESSAGE(run.code == 0, run.err);
  forget_files(folder / "out");
  std::filesystem::remove(folder / "out/loops.csv");
  const auto judge = [&] {
    return surefield_command({"eval", "--loops", folder / "out", "--json", folder / "loops.json"},
                             folder.path());
  };
  const Outcome absent = judge();
  CHECK(absent.code == 2);
  CHECK(contains(absent.err, "loops.csv"));
  CHECK(contains(absent.err, "only runs that look for loops"));

  std::ofstream(folder / "out/loops.csv") << "from,to,accepted,tx,ty,tz\n";
  CHECK(contains(judge().err, "names no column \"qx\""));
  std::ofstream(folder / "out/loops.csv") << "from,to,accepted,tx,ty,tz,qx,qy,qz,qw\n0,0,yes,0,0,0,0,0,0,1\n";
  CHECK(contains(judge().err, "has no number in column \"accepted\""));
  std::ofstream(folder / "out/loops.csv") << "from,to,accepted,tx,ty,tz,qx,qy,qz,qw\n0,0,1,0,0,0,0,0,0,0\n";
  CHECK(contains(judge().err, "no rotation"));

  // One that is true of any keyframe, one that is not, one that was not accepted, and one of no keyframe.
  std::ofstream(folder / "out/loops.csv") << "similarity,from,to,why,qx,qy,qz,qw,tx,ty,tz,accepted\n"
                                             "0.9,0,0,,0,0,0,1,0,0,0,1\n"
                                             "0.9,0,0,,0,0,0,1,0.2,0,0,1\n"
                                             "0.2,0,0,see-through,0,0,0,1,9,0,0,0\n"
                                             "0.9,0,100000,,0,0,0,1,0,0,0,1\n";
  const Outcome outcome = judge();
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  CHECK(contains(outcome.out, "revisits         0, 0 closed"));
  CHECK(contains(outcome.out, "accepted edges   2, 1 right, 1 false"));
  const nlohmann::json json = read_json(folder / "loops.json");
  CHECK(json["schema"] == "surefield-loops");
  CHECK(json["accepted"] == 2);
  CHECK(json["false"] == 1);
  CHECK(json["unjudged"] == 1);
  CHECK(json["largest_error_m"].get<double>() == doctest::Approx(0.2));
}

TEST_CASE("eval --run finds again what the run found, and needs no more than its folder") {
  const TemporaryFolder folder;
  const Outcome run = surefield_command(short_run(folder / "out"), folder.path());
  REQUIRE_MESSAGE(run.code == 0, run.err);
  // In images of another size, the map shows the same with less detail.
  const Outcome smaller = surefield_command(
      {"eval", "--run", folder / "out", "--scale", "0.4", "--json", folder / "smaller.json"}, folder.path());
  REQUIRE_MESSAGE(smaller.code == 0, smaller.err);
  const Outcome outcome =
      surefield_command({"eval", "--run", folder / "out", "--json", folder / "out.json"}, folder.path());
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  CHECK(contains(outcome.out, "ATE RMSE"));
  CHECK(contains(outcome.out, "held-out frames  PSNR"));
  CHECK(contains(outcome.out, " ms a frame"));
  CHECK_FALSE(contains(outcome.out, "nan"));
  const nlohmann::json metrics = read_json(folder / "out/metrics.json");
  const nlohmann::json json = read_json(folder / "out.json");
  CHECK(json["schema"] == "surefield-evaluation");
  const double psnr = json["images"]["psnr_db"],
               other = read_json(folder / "smaller.json")["images"]["psnr_db"];
  CHECK(other != doctest::Approx(psnr).epsilon(1e-4));
  CHECK(std::abs(other - psnr) < 10);
  CHECK(json["images"]["held_out"]["frames"] == 1);
  CHECK(json["memory"] == metrics["memory"]);
  CHECK(json["map"]["file_megabytes"].get<double>() ==
        doctest::Approx(1e-6 * static_cast<double>(std::filesystem::file_size(folder / "out/map.ply"))));
  // Poses and map went through files of 9 digits and of floats.
  for (const char* key : {"psnr_db", "psnr_same_exposure_db", "psnr_covered_db", "ssim", "depth_l1_m"}) {
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
                 "trajectory.txt: is not as run "));
}

TEST_CASE("eval compares a map with views that the run has not seen") {
  const TemporaryFolder folder;
  const Outcome synth = surefield_command(
      {"synth", "--frames", "6", "--size", "96x72", "--beside", "2", "--out", folder / "office", "--quiet"},
      folder.path());
  REQUIRE_MESSAGE(synth.code == 0, synth.err);
  const Outcome run =
      surefield_command({"run", "--dataset", folder / "office", "--out", folder / "out"}, folder.path());
  REQUIRE_MESSAGE(run.code == 0, run.err);
  const Outcome outcome = surefield_command(
      {"eval", "--run", folder / "out", "--views", folder / "office/beside", "--json", folder / "out.json"},
      folder.path());
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  CHECK(contains(outcome.out, "from the views of "));
  const nlohmann::json json = read_json(folder / "out.json");
  CHECK(json["images"]["frames"] == 6);
  CHECK(json["views"]["frames"] == 2);
  // Beside the path it is worse, but the world is the same one: elsewhere it would be noise.
  CHECK(json["views"]["psnr_db"].get<double>() > 15);
  CHECK(json["views"]["psnr_db"].get<double>() < json["images"]["psnr_db"].get<double>());

  const Outcome blind =
      surefield_command({"eval", "--run", folder / "out", "--views", folder / "nothing"}, folder.path());
  CHECK(blind.code == 2);
  CHECK(contains(blind.err, "nothing"));
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
  // As a run of another model would have left it, of a version that did not note what its files hold.
  folder.write("out/config.yaml", "depth_model: plane\n");
  nlohmann::json metrics = read_json(folder / "out/metrics.json");
  metrics.erase("run");
  folder.write("out/metrics.json", metrics.dump());
  CHECK(depth_error() != doctest::Approx(expected).epsilon(1e-3));
}

TEST_CASE("eval leaves lost frames out, and says how many there are") {
  const TemporaryFolder folder;
  const std::string truth = "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 1 1 0 0 0 0 1\n3 0 1 0 0 0 0 1\n";
  folder.write("truth.txt", truth);
  folder.write("estimate.txt", truth + "# lost\n4 9 9 9 0 0 0 1\n");
  const Outcome outcome =
      surefield_command({"eval", "--trajectory", folder / "estimate.txt", "--ground-truth",
                         folder / "truth.txt", "--json", folder / "errors.json"},
                        folder.path());
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  CHECK(contains(outcome.out, "poses compared   4 of 5, 1 lost"));
  CHECK(read_json(folder / "errors.json")["lost"] == 1);
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

TEST_CASE("eval reads KITTI's rows as those of the truth or of a dataset's frames, and says what it read") {
  const TemporaryFolder folder;
  write_trajectory(folder / "truth.txt", square(0));
  folder.write("kitti.txt",
               "1 0 0 -1 0 1 0 -1 0 0 1 0.02\n1 0 0 1 0 1 0 -1 0 0 1 -0.02\n1 0 0 1 0 1 0 1 0 0 1 0.02\n"
               "1 0 0 -1 0 1 0 1 0 0 1 -0.02\n");
  const auto compare = [&](const std::string& estimate, const std::string& truth,
                           const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"eval", "--trajectory", folder / estimate, "--ground-truth",
                                          folder / truth};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return surefield_command(arguments, folder.path());
  };
  for (const auto& [estimate, truth] :
       {std::pair("kitti.txt", "truth.txt"), std::pair("truth.txt", "kitti.txt")}) {
    const Outcome outcome = compare(estimate, truth);
    CHECK_MESSAGE(outcome.code == 0, outcome.err);
    CHECK(contains(outcome.out, "kitti, 4 poses without stamps"));
    CHECK(contains(outcome.out, "ATE RMSE         2.000 cm"));
    // The stamps of the truth are whole numbers: of frames, for all that is known.
    CHECK_FALSE(contains(outcome.out, "RPE per second"));
  }
  folder.write("times.txt", "0.0\n0.5\n1.0\n1.5\n");
  const Outcome stamped = compare("kitti.txt", "kitti.txt", {"--stamps", folder / "times.txt"});
  CHECK(contains(stamped.out, "RPE per second   0.000 cm"));
  folder.write("short.txt", "1 0 0 -1 0 1 0 -1 0 0 1 0.02\n");
  const Outcome outcome = compare("short.txt", "truth.txt");
  CHECK(outcome.code == 2);
  CHECK(contains(outcome.err, "its 1 poses have no stamps, and the truth has 4 poses"));
}

TEST_CASE("eval aligns with a scale, or not at all, where it is asked to") {
  const TemporaryFolder folder;
  Trajectory small = moved(square(0));
  for (StampedPose& pose : small) pose.camera_to_world.translation() *= 0.25;
  write_trajectory(folder / "estimate.txt", small);
  write_trajectory(folder / "truth.txt", square(0));
  const auto compare = [&](const std::string& kind) {
    return surefield_command({"eval", "--trajectory", folder / "estimate.txt", "--ground-truth",
                              folder / "truth.txt", "--align", kind, "--json", folder / "errors.json"},
                             folder.path());
  };
  const Outcome similar = compare("sim3");
  CHECK_MESSAGE(similar.code == 0, similar.err);
  CHECK(contains(similar.out, "scale            4\n"));
  CHECK(contains(similar.out, "ATE RMSE         0.000 cm"));
  const nlohmann::json json = read_json(folder / "errors.json");
  CHECK(json["alignment"] == "sim3");
  CHECK(json["scale"].get<double>() == doctest::Approx(4).epsilon(1e-6));
  CHECK(json["rpe_1s_translation_rmse_m"].is_null());
  CHECK(compare("none").code == 0);
  CHECK(read_json(folder / "errors.json")["ate_rmse_m"].get<double>() > 1);
  CHECK(compare("affine").code == 2);
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
  Trajectory later = square(0);
  for (StampedPose& pose : later) pose.timestamp += 1000;
  write_trajectory(folder / "later.txt", later);
  CHECK(contains(message(folder / "later.txt"), "clocks differ by 1000.000 s"));
  CHECK(contains(message(folder.path()), "no known dataset layout"));
  CHECK(contains(surefield_command({"eval"}, folder.path()).err, "give --run, --trajectory, --loops, or"));
  CHECK(contains(surefield_command({"eval", "--run", folder.path()}, folder.path()).err,
                 "is this a folder that surefield run has written?"));
}
