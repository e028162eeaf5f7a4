#include <fmt/format.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "engine/config/config.h"
#include "engine/formats/triangle_mesh.h"
#include "engine/io/files.h"
#include "engine/io/images.h"
#include "engine/slam/settings.h"
#include "tests/tools/support.h"

using namespace surefield;
using namespace surefield::test;

namespace {

/// A colour that goes up and down, so that the wall can be tracked.
uchar wave(double phase) {
  return static_cast<uchar>(127 + 100 * std::sin(phase));
}

/// A sequence in the layout of Replica that takes no time: three frames of a wall with colours on it.
void write_wall(const TemporaryFolder& folder, const std::string& name) {
  constexpr int kWidth = 32, kHeight = 24;
  folder.write(
      name + "/cam_params.json",
      R"({"camera": {"w": 32, "h": 24, "fx": 30, "fy": 30, "cx": 15.5, "cy": 11.5, "scale": 1000}})");
  std::filesystem::create_directories(folder / (name + "/results"));
  std::string poses;
  for (int i = 0; i < 3; ++i) {
    cv::Mat colour(kHeight, kWidth, CV_8UC3);
    for (int v = 0; v < kHeight; ++v)
      for (int u = 0; u < kWidth; ++u)
        colour.at<cv::Vec3b>(v, u) =
            cv::Vec3b(wave(0.5 * (u + i)), wave(0.6 * v), wave(0.3 * (u + i) + 0.2 * v));
    const std::string number = "00000" + std::to_string(i);
    write_png(folder / (name + "/results/depth" + number + ".png"),
              cv::Mat(kHeight, kWidth, CV_16UC1, cv::Scalar(2000)));
    // The reader goes by what is in the file, not by its name.
    write_png(folder / (name + "/results/colour.png"), colour);
    std::filesystem::rename(folder / (name + "/results/colour.png"),
                            folder / (name + "/results/frame" + number + ".jpg"));
    poses += "1 0 0 " + std::to_string(0.067 * i) + " 0 1 0 0 0 0 1 0 0 0 0 1\n";
  }
  folder.write(name + "/traj.txt", poses);
}

/// Runs tools/reproduce with the program under test.
Outcome reproduce(const TemporaryFolder& folder, const std::string& arguments) {
  const char* device = std::getenv("SUREFIELD_DEVICE");
  const std::string own = (device ? std::string(" --device '") + device + "'" : "") +
                          " -- --quiet --set first_iterations=2 --set adam.first_iterations=2"
                          " --set adam.iterations=2 --set mapping_iterations=1";
  const std::string command = "SUREFIELD='" SUREFIELD_PROGRAM "' bash '" SUREFIELD_SOURCE_DIR
                              "/tools/reproduce' " +
                              arguments + (arguments.starts_with("--help") ? "" : own) + " >'" +
                              (folder / "out.txt").string() + "' 2>'" + (folder / "err.txt").string() + "'";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(folder / "out.txt"),
          read_file(folder / "err.txt")};
}

/// The cells of the row that starts with `method` below the heading `title`.
std::string row_of(const std::string& tables, const std::string& title, const std::string& method) {
  const std::size_t heading = tables.find("## " + title);
  REQUIRE(heading != std::string::npos);
  const std::size_t row = tables.find("| " + method + " |", heading);
  REQUIRE(row != std::string::npos);
  return tables.substr(row, tables.find('\n', row) - row);
}

}  // namespace

TEST_CASE("reproduce runs what it finds, resumes, and puts its results beside the published ones") {
  const TemporaryFolder folder;
  write_wall(folder, "data/Replica/room0");
  const std::string arguments = "tracking-replica runtime --data '" + (folder / "data").string() +
                                "' --out '" + (folder / "out").string() + "' --seeds 2";
  const Outcome first = reproduce(folder, arguments);
  REQUIRE_MESSAGE(first.code == 0, first.err, first.out);
  CHECK(contains(first.out, "== replica/room0/full/seed2\n"));
  CHECK(contains(first.out, "== replica/office0: left out, no such sequence in"));
  const std::string tables = read_file(folder / "out/tables.md");
  CHECK(row_of(tables, "Tracking on Replica", "CG-SLAM") ==
        "| CG-SLAM | 0.29 | 0.27 | 0.25 | 0.33 | 0.14 | 0.28 | 0.31 | 0.29 | 0.27 |");
  const std::string own = row_of(tables, "Tracking on Replica", "**Surefield**");
  CHECK(contains(own, " ± "));
  CHECK(own.ends_with(" | - | - | - | - | - | - | - | - |"));  // seven scenes and the mean were not run
  CHECK(contains(tables, "images of 32 x 24"));
  CHECK(contains(tables, "- Surefield: 3 frames a run\n"));
  CHECK_FALSE(contains(tables, "## Runtime"));  // nothing was run for it

  const auto written =
      std::filesystem::last_write_time(folder / "out/runs/replica/room0/full/seed1/metrics.json");
  const Outcome second = reproduce(folder, arguments);
  CHECK(second.code == 0);
  CHECK(contains(second.out, "== replica/room0/full/seed1: done before"));
  CHECK(std::filesystem::last_write_time(folder / "out/runs/replica/room0/full/seed1/metrics.json") ==
        written);
  CHECK(read_file(folder / "out/tables.md") == tables);
  // Other settings are another run.
  const Outcome third = reproduce(folder, arguments + " --scale 0.75");
  CHECK(third.code == 0);
  CHECK_FALSE(contains(third.out, "done before"));
  CHECK(contains(read_file(folder / "out/tables.md"), "images of 24 x 18"));
}

TEST_CASE("reproduce that finds no data says what to fetch and writes no table") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "data");
  for (const std::string& data : {std::string(), " --data '" + (folder / "data").string() + "'"}) {
    const Outcome outcome =
        reproduce(folder, "tracking-tum runtime --out '" + (folder / "out").string() + "'" + data);
    CHECK(outcome.code == 2);
    CHECK(contains(outcome.err, "none of the sequences of tracking-tum runtime is in "));
    CHECK(contains(outcome.err, "surefield fetch"));
    CHECK_FALSE(std::filesystem::exists(folder / "out/tables.md"));
  }
}

TEST_CASE("reproduce measures surfaces where there is a true mesh, and says where there is none") {
  const TemporaryFolder folder;
  write_wall(folder, "data/room0");
  write_wall(folder, "data/room1");
  // The wall, 2 m before the cameras.
  write_mesh(folder / "data/room0_mesh.ply",
             {{{-3, -3, 2}, {3, -3, 2}, {3, 3, 2}, {-3, 3, 2}}, {}, {{0, 1, 2}, {0, 2, 3}}});
  const Outcome outcome = reproduce(folder, "reconstruction --data '" + (folder / "data").string() +
                                                "' --out '" + (folder / "out").string() + "'");
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err, outcome.out);
  CHECK(contains(outcome.out, "== replica/room1: surfaces left out, no room1.ply or room1_mesh.ply in"));
  const nlohmann::json json = read_json(folder / "out/runs/replica/room0/full/seed1/mesh.json");
  const double accuracy = 100 * json["mesh"]["point_to_point"]["accuracy_m"].get<double>();
  const std::string row = row_of(read_file(folder / "out/tables.md"), "Reconstruction on Replica",
                                 "**Surefield** | Accuracy [cm]");
  CHECK(contains(row, fmt::format("| {:.2f} | - |", accuracy)));
}

TEST_CASE("[slow] reproduce makes synthetic scenes itself, and measures their surfaces") {
  const TemporaryFolder folder;
  const std::string arguments = "synthetic --frames 3 --scale 0.1 --out '" + (folder / "out").string() + "'";
  const Outcome outcome = reproduce(folder, arguments);
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err, outcome.out);
  const std::string tables = read_file(folder / "out/tables.md");
  for (const char* metric : {"ATE RMSE [cm]", "PSNR [dB]", "Accuracy, nearest triangle [cm]"}) {
    CAPTURE(metric);
    const std::string row = row_of(tables, "Synthetic scenes", std::string("**Surefield** | ") + metric);
    CHECK_FALSE(contains(row, "| - |"));
  }
}

TEST_CASE("tables give mean and spread over seeds, and a mean over scenes only where all were run") {
  const TemporaryFolder folder;
  const auto write_run = [&](const std::string& place, double ate, const std::string& status = "completed") {
    const nlohmann::json metrics = {
        {"status", status},
        {"program", {{"commit", "abc"}}},
        {"device", {{"name", "a device"}}},
        {"dataset", {{"width", 64}, {"height", 48}}},
        {"trajectory", {{"ate_rmse_m", ate}}},
        {"frames", {{"fed", 100}, {"keyframes", 20}}},
        {"time", {{"tracking_ms_per_iteration", 2.5}, {"tracking_iterations", 1500}}}};
    folder.write("runs/" + place + "/metrics.json", metrics.dump());
  };
  const std::vector<std::string> scenes = {"scene0000", "scene0059", "scene0106",
                                           "scene0169", "scene0181", "scene0207"};
  for (const std::string& scene : scenes) {
    write_run("scannet/" + scene + "/full/seed1", 0.06);
    write_run("scannet/" + scene + "/full/seed2", 0.08);
  }
  write_run("scannet/scene0000/full/seed3", 5, "interrupted");  // does not count
  write_run("replica/office0/full/seed1", 0.01);
  const nlohmann::json surface = {{"accuracy_m", 0.0123}, {"completion_ratio_5cm", 0.9}};
  folder.write("runs/replica/office0/full/seed1/mesh.json",
               nlohmann::json{{"mesh", {{"point_to_point", surface}}}}.dump());
  const Outcome outcome =
      surefield_command({"tables", "--runs", folder / "runs", "--published",
                         SUREFIELD_SOURCE_DIR "/tools/published.csv", "--out", folder / "tables.md"},
                        folder.path());
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  const std::string tables = read_file(folder / "tables.md");
  // sqrt(2) of spread for 6 and 8.
  const std::string cell = " 7.00 ± 1.41 |";
  std::string expected = "| **Surefield** |";
  for (int i = 0; i < 7; ++i) expected += cell;
  CHECK(row_of(tables, "Tracking on ScanNet", "**Surefield**") == expected);
  CHECK(contains(row_of(tables, "Tracking on Replica", "**Surefield**"),
                 "| - | - | - | 1.00 | - | - | - | - | - |"));
  CHECK(contains(row_of(tables, "Reconstruction on Replica", "**Surefield** | Accuracy [cm]"),
                 "| - | 1.23 | -"));
  CHECK(contains(row_of(tables, "Reconstruction on Replica", "CG-SLAM | Accuracy [cm]"), "| 0.85 | 0.67 |"));
  CHECK(contains(row_of(tables, "Reconstruction on Replica", "**Surefield** | Completion ratio < 5 cm [%]"),
                 "| 90.00 |"));
  CHECK(contains(row_of(tables, "Runtime and memory on Replica office0", "**Surefield**"),
                 "| 2.50 x 15 | - | 5.0 |"));
  CHECK(contains(row_of(tables, "Runtime and memory on Replica office0", "CG-SLAM"),
                 "| 7.89 x 15 | 12.2 x 60 | 30 | 8.5 | 231.66 |"));
  CHECK(contains(surefield_command({"tables", "tracking-mars", "--runs", "x", "--published",
                                    SUREFIELD_SOURCE_DIR "/tools/published.csv", "--out", folder / "t"},
                                   folder.path())
                     .err,
                 "there is no table tracking-mars; there are tracking-replica"));
}

TEST_CASE("reproduce ablates sequences of its own and the clips that are there, with settings that exist") {
  const TemporaryFolder folder;
  folder.write("data/tum_fr1_xyz/rgb.txt", "");
  // In place of the program: notes what it is asked to do, and has done it.
  folder.write("program", R"(#!/usr/bin/env bash
case $1 in
  run) echo "$@" >>"$(dirname "$0")/calls.txt"; echo '"status": "completed"' >"$5/metrics.json" ;;
  synth) echo "$@" >>"$(dirname "$0")/calls.txt" ;;
  tables) touch "${@: -1}" ;;
esac
)");
  const auto ablate = [&](const std::string& more) {
    const std::string command = "SUREFIELD='" + (folder / "program").string() +
                                "' bash '" SUREFIELD_SOURCE_DIR "/tools/reproduce' ablations --data '" +
                                (folder / "data").string() + "' --out '" + (folder / "out").string() + "' " +
                                more + " >'" + (folder / "out.txt").string() + "' 2>&1";
    CHECK(std::system(command.c_str()) == 0);
    return read_file(folder / "out.txt");
  };
  std::filesystem::permissions(folder / "program", std::filesystem::perms::owner_all);
  CHECK(contains(ablate(""), "== ablations/room0: left out, no such clip in "));
  const std::string calls = read_file(folder / "calls.txt");
  CHECK(contains(calls,
                 "synth --scene apartment --path fast --sensor kinect --frames 80 --seed 1 --size 320x240"));
  CHECK(contains(calls, "/synth/ablations/office --out " +
                            (folder / "out/runs/ablations/office/full/seed3").string() +
                            " --overwrite --scale 0.5 --set seed=3 --frames 80\n"));
  CHECK(contains(
      calls,
      "/ablations/fr1_xyz/no-align/seed1 --overwrite --scale 0.25 --set seed=1 --set mapping.weight_align=0 "
      "--frames 60\n"));
  SlamSettings settings;
  ConfigSchema schema;
  settings.bind(schema);
  std::istringstream words(calls);
  int assignments = 0;
  for (std::string word; words >> word;) {
    if (word != "--set" || !(words >> word)) continue;
    CHECK_NOTHROW(schema.set(word));
    ++assignments;
  }
  CHECK(assignments > 4 * 3 * 14);  // each run has its seed, and most a variant
  // Done before, and again with other sizes.
  CHECK_FALSE(contains(ablate(""), "\n== ablations/office/full/seed1\n"));
  CHECK(read_file(folder / "calls.txt") == calls);
  ablate("--scale 0.3 --frames 9 --seeds 1");
  CHECK(contains(read_file(folder / "calls.txt"),
                 "/office/full/seed1 --overwrite --scale 0.3 --set seed=1 --frames 9\n"));
}

TEST_CASE("ablations mark what lies within the spread, and name what is beyond") {
  const TemporaryFolder folder;
  const auto write_runs = [&](const std::string& variant, double ate, double psnr, int seeds = 3) {
    for (const char* scene : {"office", "corridor"}) {
      for (int seed = 1; seed <= seeds; ++seed) {
        const nlohmann::json metrics = {{"status", "completed"},
                                        {"trajectory", {{"ate_rmse_m", ate + 0.001 * seed}}},
                                        {"images", {{"psnr_db", psnr + 0.1 * seed}}}};
        folder.write(fmt::format("runs/ablations/{}/{}/seed{}/metrics.json", scene, variant, seed),
                     metrics.dump());
      }
    }
  };
  const auto tables = [&] {
    const Outcome outcome =
        surefield_command({"tables", "ablations", "--runs", folder / "runs", "--published",
                           SUREFIELD_SOURCE_DIR "/tools/published.csv", "--out", folder / "tables.md"},
                          folder.path());
    REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
    return read_file(folder / "tables.md");
  };
  write_runs("full", 0.010, 30);
  write_runs("no-align", 0.0113, 29);     // 1.3 mm of a spread of 1.4, and 1 dB of 0.14
  write_runs("no-variance", 0.0085, 30);  // 1.5 mm, and nothing
  write_runs("tracking-adam", 0.012, 31, 1);
  // A clip that was run with some variants alone takes no part.
  folder.write("runs/ablations/room0/no-align/seed1/metrics.json",
               R"({"status": "completed", "trajectory": {"ate_rmse_m": 5}})");
  const std::string text = tables();
  CHECK(contains(text, "Mean over office, corridor."));
  CHECK(contains(text, "| variant | ATE RMSE [cm] | PSNR [dB] | Depth L1 [cm] | ATE RMSE [cm], office |"));
  CHECK(row_of(text, "Ablations", "**full**") ==
        "| **full** | 1.200 ± 0.100 | 30.20 ± 0.10 | - | 1.200 ± 0.100 | 1.200 ± 0.100 |");
  CHECK(row_of(text, "Ablations", "**without L_align**") ==
        "| **without L_align** | ≈ 1.330 ± 0.100 | 29.20 ± 0.10 | - | ≈ 1.330 ± 0.100 | ≈ 1.330 ± 0.100 |");
  CHECK(row_of(text, "Ablations", "**without L_var**") ==
        "| **without L_var** | 1.050 ± 0.100 | ≈ 30.20 ± 0.10 | - | 1.050 ± 0.100 | 1.050 ± 0.100 |");
  CHECK(row_of(text, "Ablations", "**tracking by Adam**") ==
        "| **tracking by Adam** | 1.300 | 31.10 | - | 1.300 | 1.300 |");
  CHECK(contains(text, "\nBetter than full beyond the spread: without L_var (ATE RMSE [cm]).\n"));
  CHECK(contains(text, "\nWorse than full beyond the spread: without L_align (PSNR [dB]).\n"));

  std::filesystem::remove_all(folder / "runs/ablations");
  write_runs("full", 0.010, 30, 1);
  const std::string one = tables();
  CHECK(contains(one, "One seed does not tell a difference from chance"));
  CHECK_FALSE(contains(one, "beyond the spread"));
}

TEST_CASE("reproduce explains itself and refuses what it does not know") {
  const TemporaryFolder folder;
  const Outcome help = reproduce(folder, "--help");
  CHECK(help.code == 0);
  CHECK(contains(help.out, "Examples:"));
  CHECK(contains(reproduce(folder, "tracking-mars").err, "there is no table tracking-mars"));
  CHECK(contains(reproduce(folder, "--data /no/such").err, "--data /no/such is no folder"));
  CHECK(reproduce(folder, "--seeds none").code == 2);
}
