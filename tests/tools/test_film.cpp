// Films: surefield render --path and surefield run --film.
#include <signal.h>

#include <cmath>
#include <opencv2/videoio.hpp>

#include "engine/formats/ply.h"
#include "engine/io/file_names.h"
#include "engine/io/files.h"
#include "engine/io/images.h"
#include "engine/io/trajectory_file.h"
#include "engine/types/trajectory.h"
#include "tests/tools/support.h"

using namespace surefield;
using namespace surefield::test;

namespace {

/// Five Gaussians in a cross, 3 m ahead, each of its own colour.
void write_cross(const std::filesystem::path& file) {
  GaussianCloud cloud;
  cloud.resize(5);
  cloud.means = {{0, 0, 3}, {0.6f, 0, 3}, {-0.6f, 0, 3}, {0, 0.4f, 3}, {0, -0.4f, 3.3f}};
  cloud.sh.clear();
  for (int i = 0; i < 5; ++i) {
    cloud.log_scales[i].setConstant(std::log(0.1f));
    cloud.opacity_logits[i] = 3;
    for (int c = 0; c < 3; ++c) cloud.sh.push_back((i >> c) % 2 == 0 ? 1.5f : -1.0f);
  }
  write_ply(file, cloud);
}

int pictures_of(const std::filesystem::path& film, const cv::Size& size) {
  cv::VideoCapture video(film.string());
  int count = 0;
  for (cv::Mat picture; video.read(picture); ++count) CHECK(picture.size() == size);
  return count;
}

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

/// Whether the pictures became a film and no series; says so where there is no codec.
bool has_film(const std::filesystem::path& film, const Outcome& outcome) {
  if (std::filesystem::exists(film)) return true;
  CHECK(contains(outcome.err, "has no codec"));
  MESSAGE("skipped: no codec for ", film.string());
  return false;
}

}  // namespace

TEST_CASE("render --path orbit films the map, one film for each mode") {
  const TemporaryFolder folder;
  write_cross(folder / "map.ply");
  const Outcome outcome = surefield_command(
      {"render", "--map", folder / "map.ply", "--path", "orbit", "--out", folder / "films/orbit.avi",
       "--mode", "colour", "--mode", "points", "--size", "64x48", "--fps", "10", "--seconds", "0.6"},
      folder.path());
  CHECK_MESSAGE(outcome.code == 0, outcome.err);
  CHECK(contains(outcome.out, "6 pictures of 64 x 48"));
  for (const char* name : {"films/orbit_colour.avi", "films/orbit_points.avi"})
    if (has_film(folder / name, outcome)) CHECK(pictures_of(folder / name, {64, 48}) == 6);
}

TEST_CASE("a path of keys shows at its keys what a camera there sees") {
  const TemporaryFolder folder;
  write_cross(folder / "map.ply");
  const std::string lens = R"("width": 64, "height": 48, "fx": 50, "fy": 50, "cx": 32, "cy": 24, )";
  const std::string pose = R"("world_to_camera": [[1,0,0,0.1],[0,1,0,-0.05],[0,0,1,0.2],[0,0,0,1]])";
  const auto camera = folder.write("camera.json", "{" + lens + pose + "}");
  const auto keys =
      folder.write("keys.json", "{" + lens + R"("keys": [{"time": 0, )" + pose +
                                    R"(}, {"time": 0.5, "position": [1, 0, 0], "look_at": [0, 0, 3]}]})");
  const auto render = [&](const std::vector<std::string>& arguments) {
    const Outcome outcome =
        surefield_command(with({"render", "--map", folder / "map.ply"}, arguments), folder.path());
    CHECK_MESSAGE(outcome.code == 0, outcome.err);
  };
  render({"--camera", camera, "--mode", "colour", "--out", folder / "single"});
  render({"--path", keys, "--fps", "8", "--out", folder / "series"});
  const cv::Mat expected = read_colour(folder / "single/colour.png");
  CHECK(cv::countNonZero(expected.reshape(1)) > 500);
  CHECK(cv::norm(read_colour(folder / "series/000000.png"), expected, cv::NORM_INF) == 0);
  CHECK(cv::norm(read_colour(folder / "series/000004.png"), expected, cv::NORM_INF) > 0);
  CHECK_FALSE(std::filesystem::exists(folder / "series/000005.png"));
}

TEST_CASE("render follows the camera of a run, and shows what it saw from where it was") {
  const TemporaryFolder folder;
  const Outcome run = surefield_command(short_run(folder / "run"), folder.path());
  REQUIRE_MESSAGE(run.code == 0, run.err);
  const cv::Size size(read_json(folder / "run/metrics.json")["dataset"]["width"],
                      read_json(folder / "run/metrics.json")["dataset"]["height"]);
  const auto render = [&](const std::string& path, const std::vector<std::string>& more) {
    return surefield_command(
        with({"render", "--run", folder / "run", "--path", path, "--out", folder / path}, more),
        folder.path());
  };
  const auto count = [&](const std::string& name) {
    return numbered_files(folder / name, {}, ".png").size();
  };
  const Outcome own = render("trajectory", {"--mode", "all"});
  REQUIRE_MESSAGE(own.code == 0, own.err);
  for (const char* mode : {"colour", "uncertainty", "sensor", "error"})
    CHECK(count(std::string("trajectory/") + mode) == 3);
  const cv::Mat sensor = read_colour(folder / "trajectory/sensor/000002.png");
  const cv::Mat map = read_colour(folder / "trajectory/colour/000002.png");
  CHECK(sensor.size() == size);
  CHECK(cv::norm(sensor, map, cv::NORM_L1) / (3 * size.area()) < 40);

  const Outcome truth = render("truth", {});
  CHECK_MESSAGE(truth.code == 0, truth.err);
  CHECK(count("truth") == 3);

  const auto follow = [&](const std::vector<std::string>& shown) {
    std::vector<std::string> arguments = {"--size", "160x90"};
    for (const std::string& thing : shown) arguments.insert(arguments.end(), {"--show", thing});
    const Outcome outcome = render("follow", arguments);
    CHECK_MESSAGE(outcome.code == 0, outcome.err);
    REQUIRE(count("follow") == 3);
    return read_colour(folder / "follow/000002.png");
  };
  const cv::Mat bare = follow({});
  CHECK(bare.size() == cv::Size(160, 90));
  for (const char* thing : {"trajectory", "truth", "keyframes", "camera", "sensor"}) {
    CAPTURE(thing);
    CHECK(cv::norm(follow({thing}), bare, cv::NORM_INF) > 0);
  }
}

TEST_CASE("render --path says what does not go together") {
  const TemporaryFolder folder;
  write_cross(folder / "map.ply");
  const auto error = [&](const std::vector<std::string>& arguments, const std::string& out = "film") {
    const Outcome outcome = surefield_command(
        with({"render", "--map", folder / "map.ply", "--out", folder / out}, arguments), folder.path());
    CHECK(outcome.code == 2);
    return outcome.err;
  };
  CHECK(contains(error({"--path", "follow"}), "name its run with --run"));
  CHECK(contains(error({"--path", "orbit", "--show", "camera"}), "name it with --run"));
  CHECK(contains(error({"--path", "nowhere"}),
                 "is none of orbit, follow, trajectory, truth, and no such file"));
  CHECK(contains(error({"--path", "orbit", "--mode", "error"}), "--mode error needs --path trajectory"));
  CHECK(contains(error({"--path", "orbit", "--size", "12"}), "is no size such as 1280x720"));
  CHECK(contains(error({}), "--path"));
  CHECK(contains(error({"--path", "orbit"}, "film.gif"), "films end in .mp4 or .avi"));
  CHECK_FALSE(std::filesystem::exists(folder / "film"));
}

TEST_CASE("run --film films every frame and a second more, and changes nothing of the run") {
  const TemporaryFolder folder;
  const Outcome plain = surefield_command(short_run(folder / "plain"), folder.path());
  REQUIRE_MESSAGE(plain.code == 0, plain.err);
  const Outcome filmed = surefield_command(
      with(short_run(folder / "filmed"), {"--film", folder / "run.avi", "--film-size", "160x90"}),
      folder.path());
  REQUIRE_MESSAGE(filmed.code == 0, filmed.err);
  for (const std::string name : {"trajectory.txt", "keyframes.txt", "map.ply"})
    CHECK(read_file(folder / ("plain/" + name)) == read_file(folder / ("filmed/" + name)));
  CHECK(contains(filmed.out, "28 pictures"));
  if (has_film(folder / "run.avi", filmed)) CHECK(pictures_of(folder / "run.avi", {160, 90}) == 3 + 25);
}

TEST_CASE("an interrupted run leaves the film of what it did") {
  const TemporaryFolder folder;
  Program run(with(short_run(folder / "out", 60), {"--film", folder / "run.avi", "--film-size", "64x36"}),
              folder.path());
  wait_for(folder / "out.partial/log.txt", "frame 1:");
  run.signal(SIGINT);
  CHECK(run.wait() == 130);
  const auto fed = static_cast<int>(read_trajectory(folder / "out/trajectory.txt").size());
  CHECK(fed < 60);
  if (has_film(folder / "run.avi", {130, run.out(), run.err()}))
    CHECK(pictures_of(folder / "run.avi", {64, 36}) == fed + 25);
}

TEST_CASE("where filming fails the run goes on, keeps what was filmed, and the exit code tells") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "film/000001.png");  // in the place of a picture
  const Outcome outcome = surefield_command(
      with(short_run(folder / "out"), {"--film", folder / "film", "--film-size", "64x36"}), folder.path());
  CHECK(outcome.code == 1);
  CHECK(contains(outcome.err, "filming has stopped"));
  CHECK(contains(outcome.err, "000001.png"));
  CHECK(read_trajectory(folder / "out/trajectory.txt").size() == 3);
  CHECK(read_json(folder / "out/metrics.json")["status"] == "completed");
  CHECK(read_colour(folder / "film/000000.png").size() == cv::Size(64, 36));

  const Outcome unknown =
      surefield_command(with(short_run(folder / "no"), {"--film", folder / "run.gif"}), folder.path());
  CHECK(unknown.code == 2);
  CHECK(contains(unknown.err, "films end in .mp4 or .avi"));
  CHECK_FALSE(std::filesystem::exists(folder / "no"));
}
