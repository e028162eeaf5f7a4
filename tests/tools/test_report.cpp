#include <cmath>
#include <sstream>

#include "engine/io/files.h"
#include "engine/io/trajectory_file.h"
#include "engine/types/trajectory.h"
#include "tests/report/markup.h"
#include "tests/tools/support.h"

using namespace surefield;
using namespace surefield::test;

namespace {

/// What a run leaves, made up: a circle, without map and without dataset.
void write_run(const TemporaryFolder& folder, const std::string& name, int frames) {
  nlohmann::json metrics = {
      {"schema", "surefield-metrics"},
      {"version", 1},
      {"status", "completed"},
      {"error", nullptr},
      {"program", {{"version", "0"}, {"commit", "none"}}},
      {"device", {{"name", "a device"}, {"driver", ""}}},
      {"dataset",
       {{"name", "<loop> & co"},
        {"path", "/no/such/loop"},
        {"format", "tum"},
        {"width", 64},
        {"height", 48},
        {"start", 0},
        {"stride", 1},
        {"scale", 1},
        {"depth_max_m", 5}}},
      {"frames", {{"total", frames}, {"fed", frames}, {"skipped", 0}, {"lost", 1}, {"keyframes", 10}}},
      {"time", {{"total_s", 20}, {"tracking_s", 12}, {"mapping_s", 5}, {"frames_per_second", 7.25}}},
      {"trajectory", {{"ate_rmse_m", 0.0123}, {"ate_max_m", 0.04}}},
      {"images", {{"psnr_db", 31.25}}},
      {"per_frame", nlohmann::json::array()}};
  Trajectory trajectory;
  for (int i = 0; i < frames; ++i) {
    const double wave = std::sin(0.7 * i) + std::sin(0.033 * i * i);
    metrics["per_frame"].push_back({{"index", i},
                                    {"timestamp_s", i / 30.0},
                                    {"keyframe", i % 15 == 0},
                                    {"lost", i == 2},
                                    {"loss", 0.05 + 0.01 * wave},
                                    {"tracking_iterations", 30 + i % 7},
                                    {"tracking_ms", 100 + 20 * wave},
                                    {"mapping_ms", 300},
                                    {"gaussians", 1000 * i},
                                    {"device_mb", 100 + i}});
    StampedPose pose;
    pose.timestamp = i / 30.0;
    pose.camera_to_world.translation() = Eigen::Vector3d(std::cos(0.02 * i), 0.1 * wave, std::sin(0.02 * i));
    trajectory.push_back(pose);
  }
  folder.write(name + "/metrics.json", metrics.dump());
  folder.write(name + "/config.yaml", "seed: 1\nadam:\n  iterations: " + std::to_string(frames) + "\n");
  write_trajectory(folder / (name + "/trajectory.txt"), trajectory);
  write_trajectory(folder / (name + "/keyframes.txt"), {trajectory[0]});
}

std::string make_report(std::vector<std::string> arguments, const TemporaryFolder& folder) {
  arguments.insert(arguments.begin(), "report");
  arguments.insert(arguments.end(), {"--out", folder / "report.html"});
  const Outcome outcome = surefield_command(arguments, folder.path());
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  return read_file(folder / "report.html");
}

void check_self_contained(const std::string& html) {
  CHECK(nesting_problem(html) == "");
  for (const char* reference : {"http", "<script", "<link", "url("}) {
    CAPTURE(reference);
    CHECK_FALSE(contains(html, reference));
  }
}

}  // namespace

TEST_CASE("a report needs neither dataset nor device, names are escaped, and 1000 frames stay small") {
  const TemporaryFolder folder;
  write_run(folder, "a<b>&c", 1000);
  const std::string html = make_report({(folder / "a<b>&c").string()}, folder);
  check_self_contained(html);
  CHECK(html.size() < 1'000'000);
  for (const char* part :
       {"<title>Surefield: a&lt;b&gt;&amp;c</title>", "&lt;loop&gt; &amp; co",
        "1000 of 1000 frames tracked, 1 lost", "1.23 cm", "31.2 dB", "7.25 frames/s", "ATE RMSE",
        "1st and 2nd principal axis", "Tracking loss", "Time per stage", "frame 2 lost",
        "the dataset is not here", "iterations: 1000", "Gaussians in the map", "seed 1, ",
        " UTC; other than the defaults: adam.iterations = 1000"}) {
    CAPTURE(part);
    CHECK(contains(html, part));
  }
  CHECK_FALSE(contains(html, "<loop>"));
  CHECK_FALSE(contains(html, "<img"));
}

TEST_CASE("a verdict names the worst of trajectory, images, depth, floaters and the end of the run") {
  const TemporaryFolder folder;
  write_run(folder, "run", 40);
  const nlohmann::json whole = [&] {
    nlohmann::json metrics = read_json(folder / "run/metrics.json");
    metrics["frames"]["lost"] = 0;
    metrics["frames"]["doubtful_end"] = 0;
    metrics["images"] = {{"psnr_db", 25},
                         {"psnr_same_exposure_db", 26},
                         {"depth_l1_m", 0.02},
                         {"floaters", 0.01},
                         {"coverage", 0.99}};
    return metrics;
  }();
  const auto report_of = [&](const std::string& pointer, const nlohmann::json& value) {
    nlohmann::json metrics = whole;
    if (!pointer.empty()) metrics[nlohmann::json::json_pointer(pointer)] = value;
    folder.write("run/metrics.json", metrics.dump());
    return make_report({folder / "run"}, folder);
  };
  CHECK(contains(report_of("", nullptr), "<p class=\"verdict good\">"));
  struct Case {
    const char* pointer;
    double fair, bad;
    const char* reason;
  };
  for (const Case& c : {Case{"/images/psnr_same_exposure_db", 14, 9, "renders that differ"},
                        {"/images/depth_l1_m", 0.12, 0.4, "the error of the depth"},
                        {"/images/floaters", 0.06, 0.3, "floaters"},
                        {"/images/coverage", 0.85, 0.5, "holes"},
                        {"/frames/doubtful_end", 3, 20, "no certain pose at the end"},
                        {"/frames/lost", 1, 10, "frames without a pose"}}) {
    CAPTURE(c.pointer);
    const std::string fair = report_of(c.pointer, c.fair), bad = report_of(c.pointer, c.bad);
    CHECK(contains(fair, "<p class=\"verdict fair\">"));
    CHECK(contains(bad, "<p class=\"verdict bad\">"));
    CHECK(contains(fair, std::string("Not better because of: ") + c.reason));
  }
  CHECK(contains(report_of("/status", "failed"), "<p class=\"verdict bad\">"));
}

TEST_CASE("a report of a run that lacks numbers shows dashes, and no nan") {
  const TemporaryFolder folder;
  write_run(folder, "bare", 5);
  nlohmann::json metrics = read_json(folder / "bare/metrics.json");
  metrics["frames"] = {{"total", nullptr}, {"fed", 5}, {"keyframes", 0}};
  metrics["time"] = nlohmann::json::object();
  metrics["images"] = nullptr;
  metrics["trajectory"] = nullptr;
  metrics["date"] = "2026-01-02 03:04 UTC";
  folder.write("bare/metrics.json", metrics.dump());
  const std::string html = make_report({folder / "bare"}, folder);
  CHECK(contains(html, "seed 1, 2026-01-02 03:04 UTC; "));
  CHECK(contains(html, "5 frames tracked"));
  for (const char* missing : {" nan", ">nan", "-nan", "\"nan"}) CHECK_FALSE(contains(html, missing));
}

TEST_CASE("several runs stand side by side, with the settings in which they differ") {
  const TemporaryFolder folder;
  write_run(folder, "first", 40);
  write_run(folder, "second", 60);
  const std::string html = make_report({folder / "first", folder / "second"}, folder);
  check_self_contained(html);
  CHECK(contains(html, "<tr><th>adam.iterations</th><td>40</td><td>60</td></tr>"));
  CHECK_FALSE(contains(html, "<tr><th>seed</th>"));
  CHECK(contains(html, "var(--run1)"));
}

TEST_CASE("a report shows errors against the truth, and renders beside the sensor's images") {
  const TemporaryFolder folder;
  const Outcome run = surefield_command(short_run(folder / "out"), folder.path());
  REQUIRE_MESSAGE(run.code == 0, run.err);
  const std::string html = make_report({folder / "out", "--frames", "0,2"}, folder);
  check_self_contained(html);
  for (const char* part : {"ground truth", "Position error", "Rotation error", "frame 0</h3>", "frame 2</h3>",
                           "depth error (mean", "src=\"data:image/jpeg;base64,"}) {
    CAPTURE(part);
    CHECK(contains(html, part));
  }
  CHECK_FALSE(contains(html, "frame 1</h3>"));
  const Outcome wrong = surefield_command(
      {"report", folder / "out", "--frames", "7", "--out", folder / "no.html"}, folder.path());
  CHECK(wrong.code == 2);
  CHECK(contains(wrong.err, "has no frame 7"));
  CHECK_FALSE(std::filesystem::exists(folder / "no.html"));
}

TEST_CASE("a report shows of a lost frame what the sensor saw, and of those after it what the map shows") {
  const TemporaryFolder folder;
  const Outcome run = surefield_command(short_run(folder / "out"), folder.path());
  REQUIRE_MESSAGE(run.code == 0, run.err);
  const std::string before = make_report({folder / "out", "--frames", "2"}, folder);
  std::istringstream poses(read_file(folder / "out/trajectory.txt"));
  std::string marked;
  int row = 0;
  for (std::string line; std::getline(poses, line);) {
    if (line[0] != '#' && row++ == 1) marked += "# lost\n";
    marked += line + "\n";
  }
  folder.write("out/trajectory.txt", marked);
  nlohmann::json metrics = read_json(folder / "out/metrics.json");
  metrics["per_frame"][1]["lost"] = true;
  folder.write("out/metrics.json", metrics.dump());
  forget_files(folder / "out");
  const auto decibels = [](const std::string& html) {
    const auto at = html.find("rendered (");
    return at == std::string::npos ? "none" : html.substr(at, html.find(')', at) - at);
  };
  const std::string lost = make_report({folder / "out", "--frames", "1"}, folder);
  CHECK(contains(lost, ">sensor</figcaption>"));
  CHECK(decibels(lost) == "none");
  CHECK(decibels(before) != "none");
  CHECK(decibels(make_report({folder / "out", "--frames", "2"}, folder)) == decibels(before));
}

TEST_CASE("a report draws the places that looked known, and says how they were judged") {
  const TemporaryFolder folder;
  write_run(folder, "run", 100);
  CHECK_FALSE(contains(make_report({folder / "run"}, folder), "<h2>Loops</h2>"));
  folder.write("run/loops.csv",
               "from,to,similarity,overlap,see_through,correction_cm,correction_deg,accepted,why,tx,ty,tz,qx,"
               "qy,qz,qw\n3,60,0.1,0,0,0,0,0,few matches,0,0,0,0,0,0,1\n"
               "0,90,0.5,0.81,0.004,12.5,1.25,1,accepted,0,0,0,0,0,0,1\n");
  const std::string html = make_report({folder / "run"}, folder);
  check_self_contained(html);
  for (const char* part : {"2 places looked known: 1 accepted, 1 few matches.",
                           "Loops along the principal axes", "taken for true",
                           "<th>90 to 0</th><td class=\"best\">accepted</td><td>0.50</td><td>81 "
                           "%</td><td>0.4 %</td><td>12.50</td>",
                           "<th>60 to 3</th><td>few matches</td><td>0.10</td><td></td>"}) {
    CAPTURE(part);
    CHECK(contains(html, part));
  }
  folder.write("run/loops.csv", "from,to,accepted,tx,ty,tz,qx,qy,qz,qw\n0,1,x\n");
  const Outcome damaged =
      surefield_command({"report", folder / "run", "--out", folder / "no.html"}, folder.path());
  CHECK(damaged.code == 2);
  CHECK(contains(damaged.err, "loops.csv"));
}

TEST_CASE("report names what is no run") {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& path) {
    const Outcome outcome = surefield_command({"report", path}, folder.path());
    CHECK(outcome.code == 2);
    return outcome.err;
  };
  CHECK(contains(message("/no/such"), "is this a folder that surefield run has written?"));
  folder.write("odd/metrics.json", "{}");
  CHECK(contains(message(folder / "odd"), "metrics.json: is no metrics file of surefield run"));
  folder.write("old/metrics.json", R"({"schema": "surefield-metrics", "version": 0})");
  CHECK(contains(message(folder / "old"), "another version"));
}
