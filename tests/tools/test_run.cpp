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
  const Outcome outcome = surefield_command(short_run(folder / "out"), folder.path());
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
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
  CHECK(settings.depth_max == 10);

  const nlohmann::json json = read_json(folder / "out/metrics.json");
  CHECK(keys(json) == std::set<std::string>{"schema", "version", "status", "error", "program", "device",
                                            "dataset", "frames", "time", "map", "memory", "trajectory",
                                            "images", "skipped", "per_frame"});
  CHECK(json["schema"] == "surefield-metrics");
  CHECK(json["version"] == 1);
  CHECK(json["status"] == "completed");
  CHECK(json["frames"] == nlohmann::json{{"total", 3},
                                         {"fed", 3},
                                         {"skipped", 0},
                                         {"lost", json["frames"]["lost"]},
                                         {"retried", json["frames"]["retried"]},
                                         {"keyframes", 2}});
  CHECK(json["map"]["gaussians"] == read_ply(folder / "out/map.ply").cloud.size());
  CHECK(json["trajectory"]["pairs"] == 3);
  CHECK(json["time"]["frames_per_second"].get<double>() > 0);
  CHECK(json["memory"]["device_peak_mb"].get<double>() > json["map"]["megabytes"].get<double>());
  CHECK(json["dataset"]["path"] == "synthetic");
  CHECK(json["dataset"]["depth_max_m"] == 10);
  CHECK(json["images"]["frames"] == 3);
  CHECK(json["images"]["psnr_db"].get<double>() > 10);
  CHECK(json["images"]["ssim"].get<double>() > 0.1);
  CHECK(json["images"]["depth_l1_m"].get<double>() < 2);
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
        "index,timestamp_s,keyframe,lost,retries,loss,valid_fraction,tracking_iterations,tracking_ms,"
        "mapping_iterations,mapping_ms,gaussians,uncertain_gaussians,device_gaussians,"
        "device_mb");
  for (const auto& frame : frames) {
    REQUIRE(std::getline(csv, line));
    std::istringstream cells(line);
    for (const auto& column : frame.items()) {
      CAPTURE(column.key());
      std::string cell;
      std::getline(cells, cell, ',');
      const auto& value = column.value();
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
  for (const char* name : {"trajectory.txt", "keyframes.txt", "map.ply", "config.yaml"}) {
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

TEST_CASE("Ctrl-C saves everything and exits with 130") {
  const TemporaryFolder folder;
  Program program(short_run(folder / "out", 60), folder.path());
  wait_for(folder / "out/log.txt", "frame 1:");
  program.signal(SIGINT);
  CHECK(program.wait() == 130);
  CHECK(contains(program.err(), "Stopping after this frame"));
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

TEST_CASE("a second Ctrl-C quits at once") {
  const TemporaryFolder folder;
  auto arguments = short_run(folder / "out");
  arguments.insert(arguments.end(), {"--set", "first_iterations=100000"});
  Program program(arguments, folder.path());
  wait_for(folder / "out/log.txt", "frames of");
  program.signal(SIGINT);
  wait_for(folder / "stderr.txt", "Stopping");
  program.signal(SIGTERM);
  CHECK(program.wait() == 130);
  CHECK_FALSE(std::filesystem::exists(folder / "out/map.ply"));
}

TEST_CASE("[slow] a full disk costs only what does not fit") {
  const TemporaryFolder folder;
  Program program(short_run(folder / "out"), folder.path(), 16000);
  CHECK(program.wait() == 1);
  CHECK(contains(program.err(), "surefield: error: map.ply is not saved: "));
  CHECK_FALSE(std::filesystem::exists(folder / "out/map.ply"));
  CHECK(read_trajectory(folder / "out/trajectory.txt").size() == 3);
  CHECK(read_json(folder / "out/metrics.json")["frames"]["fed"] == 3);
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
