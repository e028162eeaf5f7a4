#include <signal.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "engine/config/config.h"
#include "engine/formats/ply.h"
#include "engine/io/files.h"
#include "engine/io/images.h"
#include "engine/io/trajectory_file.h"
#include "engine/slam/settings.h"
#include "engine/synth/synthetic_recording.h"
#include "engine/types/trajectory.h"
#include "tests/support/device.h"
#include "tests/tools/support.h"

using namespace surefield;
using namespace surefield::test;

namespace {

std::set<std::string> keys(const nlohmann::json& object) {
  std::set<std::string> names;
  for (const auto& item : object.items()) names.insert(item.key());
  return names;
}

/// Writes the first frames of a small synthetic sequence in the layout of Replica.
void write_replica(const TemporaryFolder& folder, int frames) {
  const SyntheticRecording recording(testing::device_options(),
                                     {.width = 64, .height = 48, .frames = frames});
  const Intrinsics k = recording.intrinsics();
  const nlohmann::json camera = {{"w", k.width}, {"h", k.height}, {"fx", k.fx},     {"fy", k.fy},
                                 {"cx", k.cx},   {"cy", k.cy},    {"scale", 6553.5}};
  folder.write("cam_params.json", nlohmann::json{{"camera", camera}}.dump());
  std::filesystem::create_directories(folder / "results");
  for (int i = 0; i < frames; ++i) {
    const Frame frame = recording.load(i).frame.value();
    cv::Mat depth;
    frame.depth.convertTo(depth, CV_16UC1, 6553.5);
    const std::string number = "00000" + std::to_string(i);
    write_png(folder / ("results/depth" + number + ".png"), depth);
    // The reader goes by what is in the file, not by its name.
    write_png(folder / ("results/colour.png"), frame.colour);
    std::filesystem::rename(folder / "results/colour.png", folder / ("results/frame" + number + ".jpg"));
  }
}

}  // namespace

TEST_CASE("a run leaves its results, and metrics of the documented schema") {
  const TemporaryFolder folder;
  folder.write("out/notes.txt", "mine");
  folder.write("out/metrics.json", "of an earlier run");
  auto arguments = short_run(folder / "out");
  const Outcome refused = surefield_command(arguments, folder.path());
  CHECK(refused.code == 2);
  CHECK(contains(refused.err, "holds files that are no results of a run (notes.txt)"));
  CHECK(read_file(folder / "out/metrics.json") == "of an earlier run");
  arguments.push_back("--overwrite");
  const Outcome outcome = surefield_command(arguments, folder.path());
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  CHECK_FALSE(std::filesystem::exists(folder / "out.partial"));
  CHECK(contains(outcome.out, "ATE RMSE"));
  CHECK(contains(outcome.out, (folder / "out").string()));
  CHECK(contains(outcome.err, "3/3"));

  CHECK(read_trajectory(folder / "out/trajectory.txt").size() == 3);
  CHECK(read_trajectory(folder / "out/keyframes.txt").size() == 2);
  CHECK(contains(read_file(folder / "out/log.txt"), "frame 2: keyframe"));
  CHECK(read_file(folder / "out/notes.txt") == "mine");
  SlamSettings settings;
  ConfigSchema schema;
  settings.bind(schema);
  schema.load_file(folder / "out/config.yaml");
  CHECK(settings.tracking.adam.iterations == 3);
  CHECK(settings.depth_max == 0);
  CHECK(settings.sensor == DepthSensor::Perfect);

  const nlohmann::json json = read_json(folder / "out/metrics.json");
  CHECK(keys(json) == std::set<std::string>{"schema", "version", "run",     "status",    "error",
                                            "date",   "program", "device",  "dataset",   "frames",
                                            "time",   "map",     "memory",  "loops",     "trajectory",
                                            "live",   "images",  "skipped", "per_frame", "up"});
  CHECK(json["schema"] == "surefield-metrics");
  CHECK(json["version"] == 1);
  CHECK(contains(read_file(folder / "out/log.txt"), "run " + json["run"]["id"].get<std::string>()));
  CHECK(keys(json["run"]["files"]) == std::set<std::string>{"trajectory.txt", "trajectory_online.txt",
                                                            "keyframes.txt", "map.ply", "frames.csv",
                                                            "loops.csv", "config.yaml"});
  CHECK(json["status"] == "completed");
  CHECK(json["frames"] == nlohmann::json{{"total", 3},
                                         {"fed", 3},
                                         {"skipped", 0},
                                         {"lost", json["frames"]["lost"]},
                                         {"poor", json["frames"]["poor"]},
                                         {"pose_share", 1.0},
                                         {"doubtful_end", json["frames"]["doubtful_end"]},
                                         {"retried", json["frames"]["retried"]},
                                         {"keyframes", 2}});
  CHECK(json["map"]["gaussians"] == read_ply(folder / "out/map.ply").cloud.size());
  CHECK(json["trajectory"]["pairs"] == 3);
  CHECK(json["time"]["frames_per_second"].get<double>() > 0);
  CHECK(json["memory"]["device_peak_mb"].get<double>() > json["map"]["megabytes"].get<double>());
  CHECK(json["dataset"]["path"] == "synthetic");
  CHECK(json["dataset"]["depth_max_m"] == 0);
  CHECK(json["images"]["frames"] == 3);
  CHECK(json["images"]["psnr_db"].get<double>() > 10);
  CHECK(json["images"]["ssim"].get<double>() > 0.1);
  CHECK(json["images"]["depth_l1_m"].get<double>() < 2);
  CHECK(json["images"]["coverage"].get<double>() > 0.5);
  CHECK(json["images"]["floaters"].get<double>() < 0.5);
  CHECK(json["images"]["held_out"]["frames"] == 1);
  CHECK(json["per_frame"].size() == 3);
  // Every key is described.
  const std::string documentation = read_file(SUREFIELD_SOURCE_DIR "/docs/evaluation.md");
  const nlohmann::json values = json.flatten();
  for (const auto& item : values.items()) {
    const std::string key = item.key().substr(item.key().rfind('/') + 1);
    if (key.find_first_not_of("0123456789") != std::string::npos)

      CHECK_MESSAGE(contains(documentation, "`" + key + "`"), key);
  }
}

TEST_CASE("frames.csv says of each frame what metrics.json says") {
  const TemporaryFolder folder;
  const Outcome outcome = surefield_command(short_run(folder / "out"), folder.path());
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  const nlohmann::ordered_json frames =
      nlohmann::ordered_json::parse(read_file(folder / "out/metrics.json"))["per_frame"];
  std::istringstream csv(read_file(folder / "out/frames.csv"));
  std::string line;
  std::getline(csv, line);
  CHECK(line ==
        "index,timestamp_s,keyframe,state,lost,gain_red,gain_green,gain_blue,retries,found_at,loss,valid_"
        "fraction,"
        "explained,seen_through,moved,sigma_cm,sigma_deg,covariance,tracking_"
        "iterations,tracking_ms,"
        "mapping_iterations,mapping_ms,loops_ms,gaussians,uncertain_gaussians,device_gaussians,"
        "device_mb");
  for (const auto& frame : frames) {
    REQUIRE(std::getline(csv, line));
    std::istringstream cells(line);
    for (const auto& column : frame.items()) {
      CAPTURE(column.key());
      std::string cell;
      std::getline(cells, cell, ',');
      const auto& value = column.value();
      if (value.is_string()) {
        CHECK(cell == value.get<std::string>());
        continue;
      }
      const double expected = value.is_boolean() ? value.get<bool>() : value.get<double>();
      CHECK(std::stod(cell) == expected);
    }
    CHECK(cells.eof());
  }
  CHECK_FALSE(std::getline(csv, line));
  CHECK(frames[0]["keyframe"] == true);
  CHECK(frames[1]["keyframe"] == false);
  CHECK(frames[2]["device_mb"].get<double>() > 0);
}

TEST_CASE("[slow] the same run gives the same bytes, and a quiet one prints nothing") {
  const TemporaryFolder folder;
  auto arguments = short_run(folder / "first", 5);
  CHECK(surefield_command(arguments, folder.path()).code == 0);
  arguments = short_run(folder / "second", 5);
  arguments.push_back("--quiet");
  const Outcome quiet = surefield_command(arguments, folder.path());
  CHECK(quiet.code == 0);
  CHECK(quiet.out + quiet.err == "");
  for (const char* name :
       {"trajectory.txt", "trajectory_online.txt", "keyframes.txt", "loops.csv", "map.ply", "config.yaml"}) {
    CAPTURE(name);
    CHECK(read_file(folder / "first" / name) == read_file(folder / "second" / name));
  }
}

TEST_CASE("a corrupt and a missing frame are skipped, counted and named") {
  const TemporaryFolder folder;
  write_replica(folder, 6);
  folder.write("results/frame000002.jpg", "no image");
  std::filesystem::remove(folder / "results/depth000004.png");
  auto arguments = short_run(folder / "out", 6);
  arguments[2] = folder.path();
  const Outcome outcome = surefield_command(arguments, folder.path());
  CHECK_MESSAGE(outcome.code == 0, outcome.err);
  CHECK(contains(outcome.out, "2 skipped"));
  CHECK(contains(outcome.out, "frame000002.jpg"));
  CHECK(contains(outcome.out, "depth000004.png"));
  CHECK(contains(read_file(folder / "out/log.txt"), "frame 2 skipped"));
  const nlohmann::json json = read_json(folder / "out/metrics.json");
  CHECK(json["frames"]["total"] == 6);
  CHECK(json["frames"]["fed"] == 4);
  CHECK(json["frames"]["skipped"] == 2);
  CHECK(json["skipped"][0]["index"] == 2);
  CHECK(json["skipped"][1]["index"] == 4);
  CHECK(json["trajectory"] == nullptr);
  CHECK(read_trajectory(folder / "out/trajectory.txt").size() == 4);
}

TEST_CASE("a signal saves everything and ends with 130") {
  const TemporaryFolder folder;
  Program program(short_run(folder / "out", 60), folder.path());
  wait_for(folder / "out.partial/log.txt", "frame 1:");
  int number = SIGINT;
  SUBCASE("SIGINT") {}
  SUBCASE("SIGTERM") {
    number = SIGTERM;
  }
  SUBCASE("SIGHUP") {
    number = SIGHUP;
  }
  program.signal(number);
  CHECK(program.wait() == 130);
  CHECK(contains(program.err(), "Stopping"));
  const nlohmann::json json = read_json(folder / "out/metrics.json");
  CHECK(json["status"] == "interrupted");
  const std::size_t fed = json["frames"]["fed"];
  CHECK(fed >= 2);
  CHECK(fed < 60);
  CHECK(read_trajectory(folder / "out/trajectory.txt").size() == fed);
  const std::string csv = read_file(folder / "out/frames.csv");
  CHECK(std::count(csv.begin(), csv.end(), '\n') == static_cast<std::ptrdiff_t>(fed) + 1);
  CHECK(read_ply(folder / "out/map.ply").cloud.size() == json["map"]["gaussians"]);
}

TEST_CASE("a signal in the middle of the first frame does not wait for its mapping") {
  const TemporaryFolder folder;
  auto arguments = short_run(folder / "out");
  arguments.insert(arguments.end(), {"--set", "first_iterations=100000"});
  Program program(arguments, folder.path());
  wait_for(folder / "out.partial/log.txt", "frames of");
  program.signal(SIGINT);
  CHECK(program.wait() == 130);
  CHECK(contains(program.err(), "Stopping"));
}

TEST_CASE("nothing computed replaces nothing") {
  const TemporaryFolder folder;
  write_replica(folder, 6);
  auto arguments = short_run(folder / "out", 6);
  arguments[2] = folder.path();
  REQUIRE(surefield_command(arguments, folder.path()).code == 0);
  const std::string before = read_file(folder / "out/metrics.json");
  for (int i = 0; i < 6; ++i) folder.write("results/depth00000" + std::to_string(i) + ".png", "no image");
  const Outcome refused = surefield_command(arguments, folder.path());
  CHECK(refused.code == 2);
  CHECK(contains(refused.err, "holds an earlier run"));
  arguments.push_back("--overwrite");
  const Outcome outcome = surefield_command(arguments, folder.path());
  CHECK(outcome.code == 2);
  CHECK(contains(outcome.err, "none of the first 5 frames can be read: "));
  CHECK(contains(outcome.err, "depth000000.png"));
  CHECK(read_file(folder / "out/metrics.json") == before);
  CHECK_FALSE(std::filesystem::exists(folder / "out.partial"));
}

TEST_CASE("what looks wrong is said before the first frame, and a strict run does not begin") {
  const TemporaryFolder folder;
  write_replica(folder, 2);
  nlohmann::json camera = read_json(folder / "cam_params.json");
  camera["camera"]["cx"] = 1000;
  folder.write("cam_params.json", camera.dump());
  auto arguments = short_run(folder / "out", 2);
  arguments[2] = folder.path();
  arguments.push_back("--strict");
  const Outcome strict = surefield_command(arguments, folder.path());
  CHECK(strict.code == 4);
  CHECK(contains(strict.err, "surefield: warning: "));
  CHECK(contains(strict.err, "1000"));
  CHECK_FALSE(std::filesystem::exists(folder / "out.partial"));
  CHECK_FALSE(std::filesystem::exists(folder / "out"));
}

TEST_CASE("depth that no pixel has in reach is named with what was read") {
  const TemporaryFolder folder;
  write_replica(folder, 6);
  auto arguments = short_run(folder / "out", 6);
  arguments[2] = folder.path();
  arguments.insert(arguments.end(), {"--assume-depth-unit", "1", "--set", "depth_max=5"});
  const Outcome outcome = surefield_command(arguments, folder.path());
  CHECK(outcome.code == 2);
  CHECK(contains(outcome.err,
                 "none of the 5 frames so far can be used: the first frame has no depth up to depth_max"));
  CHECK(contains(outcome.err, "depth_unit"));
}

TEST_CASE("a run says what share of the depth its limit leaves out, and without a limit uses all") {
  const TemporaryFolder folder;
  auto arguments = short_run(folder / "out", 2);
  CHECK_FALSE(contains(surefield_command(arguments, folder.path()).err, "leaves out"));
  arguments = short_run(folder / "near", 2);
  arguments.insert(arguments.end(), {"--set", "depth_max=2.5"});
  const Outcome outcome = surefield_command(arguments, folder.path());
  CHECK(outcome.code == 0);
  CHECK(contains(outcome.err, "surefield: depth_max, 2.5 m, leaves out "));
  CHECK(contains(outcome.err, " % of the depth\n"));
}

TEST_CASE("results of two runs that are mixed are refused") {
  const TemporaryFolder folder;
  REQUIRE(surefield_command(short_run(folder / "a", 2), folder.path()).code == 0);
  auto arguments = short_run(folder / "b", 2);
  arguments.insert(arguments.end(), {"--set", "seed=7"});
  REQUIRE(surefield_command(arguments, folder.path()).code == 0);
  std::string file = "config.yaml";
  SUBCASE("the settings of one and the map of another") {}
  SUBCASE("the map") {
    file = "map.ply";
  }
  SUBCASE("metrics") {
    file = "metrics.json";
  }
  std::filesystem::copy_file(folder / "a" / file, folder / "b" / file,
                             std::filesystem::copy_options::overwrite_existing);
  for (const char* command : {"eval", "report"}) {
    std::vector<std::string> reading = {command, folder / "b"};
    if (reading[0] == "eval") reading.insert(reading.begin() + 1, "--run");
    if (reading[0] == "report") reading.insert(reading.end(), {"--out", folder / "report.html"});
    const Outcome outcome = surefield_command(reading, folder.path());
    CHECK(outcome.code == 2);
    CHECK(contains(outcome.err, "results of two runs are mixed"));
  }
}

TEST_CASE("two runs at once: the second one is refused") {
  const TemporaryFolder folder;
  Program first(short_run(folder / "out", 60), folder.path());
  wait_for(folder / "out.partial/log.txt", "run ");
  std::filesystem::create_directories(folder / "second");
  auto arguments = short_run(folder / "out", 60);
  arguments.push_back("--overwrite");
  const Outcome second = surefield_command(arguments, folder / "second");
  CHECK(second.code == 2);
  CHECK(contains(second.err, "another run is writing there"));
}

TEST_CASE("more than a tenth of unusable frames is said, also by a quiet run") {
  const TemporaryFolder folder;
  write_replica(folder, 6);
  folder.write("results/frame000002.jpg", "no image");
  auto arguments = short_run(folder / "out", 6);
  arguments[2] = folder.path();
  arguments.push_back("--quiet");
  const Outcome outcome = surefield_command(arguments, folder.path());
  CHECK(outcome.code == 0);
  CHECK(contains(outcome.err, "1 of 6 frames could not be used, the first because: "));
  CHECK(contains(outcome.err, "frame000002.jpg"));
}

TEST_CASE("[slow] on a full disk what fits stays beside, and an earlier run where it was") {
  const TemporaryFolder folder;
  Program program(short_run(folder / "out"), folder.path(), 16000);
  CHECK(program.wait() == 1);
  CHECK(contains(program.err(), "surefield: error: map.ply is not saved: "));
  CHECK_FALSE(std::filesystem::exists(folder / "out"));
  CHECK(read_trajectory(folder / "out.partial/trajectory.txt").size() == 3);
  CHECK(read_json(folder / "out.partial/metrics.json")["frames"]["fed"] == 3);
}

TEST_CASE("a device that is not there is a device error") {
  const TemporaryFolder folder;
  auto arguments = short_run(folder / "out");
  arguments.insert(arguments.end(), {"--device", "no such device"});
  const Outcome outcome = surefield_command(arguments, folder.path());
  CHECK(outcome.code == 3);
  CHECK(outcome.err.starts_with("surefield: error: "));
  CHECK(contains(outcome.err, "no such device"));
}
