#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <optional>

#include "engine/eval/image_metrics.h"
#include "engine/formats/map_file.h"
#include "engine/io/files.h"
#include "engine/io/images.h"
#include "engine/io/trajectory_file.h"
#include "engine/types/trajectory.h"
#include "tests/tools/support.h"

using namespace surefield;
using namespace surefield::test;

namespace {

/// What stands between two marks.
std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const auto start = text.find(from);
  REQUIRE(start != std::string::npos);
  return text.substr(start + from.size(), text.find(to, start) - start - from.size());
}

nlohmann::json run_of(const std::string& page) {
  return nlohmann::json::parse(between(page, "id=\"run\">", "</script>"));
}

/// The first Chromium of the system; empty (with a message) where there is none.
std::string find_chromium() {
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"})
    if (std::system(fmt::format("command -v {} >/dev/null", name).c_str()) == 0) return name;
  MESSAGE("skipped: no chromium on this machine");
  return {};
}

/// What the browser shows at the address, as RGB floats. It needs no GPU, display or network.
cv::Mat screenshot(const std::string& chromium, const TemporaryFolder& folder, const std::string& address,
                   cv::Size size) {
  const std::string file = folder / "screenshot.png";
  const std::string command = fmt::format(
      "timeout 200 {} --headless --no-sandbox --disable-quic --no-first-run --disable-background-networking "
      "--disable-component-update --disable-sync --user-data-dir='{}' --use-gl=angle "
      "--use-angle=swiftshader --enable-unsafe-swiftshader --hide-scrollbars --force-device-scale-factor=1 "
      "--window-size={},{} --virtual-time-budget=20000 --screenshot='{}' '{}' >'{}' 2>&1",
      chromium, (folder / "profile").string(), size.width, size.height, file, address,
      (folder / "chromium.txt").string());
  const int code = std::system(command.c_str());
  CHECK_MESSAGE(code == 0, read_file(folder / "chromium.txt"));
  const cv::Mat image = cv::imread(file);
  REQUIRE(image.size() == size);
  cv::Mat floats;
  image.convertTo(floats, CV_32FC3, 1.0 / 255);
  return floats;
}

/// PSNR over the pixels that the map covers.
double interior_psnr(const cv::Mat& image, const cv::Mat& reference, const cv::Mat& opacity) {
  cv::Mat a, b;
  for (int y = 0; y < opacity.rows; ++y)
    for (int x = 0; x < opacity.cols; ++x) {
      if (opacity.at<float>(y, x) < 0.95f) continue;
      a.push_back(image.at<cv::Vec3f>(y, x));
      b.push_back(reference.at<cv::Vec3f>(y, x));
    }
  REQUIRE(a.rows > opacity.rows * opacity.cols / 3);
  return psnr(a, b);
}

/// A camera of `scale` times the page's size at one of its poses: as a file for render, and as the page wants
/// it.
struct View {
  cv::Size size;
  std::string address;

  View(const TemporaryFolder& folder, const nlohmann::json& run, std::size_t frame, int scale) {
    const nlohmann::json& c = run["camera"];
    const auto centre = [&](const char* key) { return (c[key].get<double>() + 0.5) * scale - 0.5; };
    const double fx = c["fx"].get<double>() * scale, fy = c["fy"].get<double>() * scale;
    size = {c["width"].get<int>() * scale, c["height"].get<int>() * scale};
    const auto p = run["estimate"][frame].get<std::vector<double>>();
    Eigen::Isometry3d pose(Eigen::Quaterniond(p[6], p[3], p[4], p[5]).normalized());
    pose.pretranslate(Eigen::Vector3d(p[0], p[1], p[2]));
    const Eigen::Matrix4d m = pose.inverse().matrix();
    nlohmann::json camera = {{"width", size.width}, {"height", size.height}, {"fx", fx}, {"fy", fy},
                             {"cx", centre("cx")},  {"cy", centre("cy")}};
    for (int row = 0; row < 4; ++row)
      camera["world_to_camera"].push_back({m(row, 0), m(row, 1), m(row, 2), m(row, 3)});
    folder.write("camera.json", camera.dump());
    address = fmt::format("#camera={},{},{},{},{},{}&pose={}", fx, fy, centre("cx"), centre("cy"), size.width,
                          size.height, fmt::join(p, ","));
  }
};

}  // namespace

TEST_CASE("export --web writes one page that holds everything, of a run and of a map alone") {
  const TemporaryFolder folder;
  GaussianCloud cloud;
  cloud.sh_degree = 1;
  cloud.resize(3);
  write_map(folder / "a<b.ply", cloud);
  const auto page_of = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "export");
    arguments.insert(arguments.end(), {"--web", folder / "web/deep"});
    const Outcome outcome = surefield_command(arguments, folder.path());
    CHECK_MESSAGE(outcome.code == 0, outcome.err);
    return read_file(folder / "web/deep/index.html");
  };
  const std::string alone = page_of({"--map", folder / "a<b.ply"});
  CHECK(contains(alone, "<title>a&lt;b</title>"));
  CHECK(between(alone, "id=\"map\">", "</script>").starts_with("H4sI"));  // gzip in base64
  CHECK(run_of(alone)["keyframes"].empty());
  CHECK(run_of(alone)["sh_degree"] == 1);
  for (const char* part :
       {"@MAP@", "@SAMPLING@", "@RUN@", "@SCRIPT@", "@TITLE@", "http://", "https://", " src=", "import "})
    CHECK_FALSE(contains(alone, part));

  const Outcome run = surefield_command(short_run(folder / "out"), folder.path());
  REQUIRE_MESSAGE(run.code == 0, run.err);
  const nlohmann::json whole = run_of(page_of({"--run", folder / "out"}));
  CHECK(whole["estimate"].size() == 3);
  CHECK(whole["truth"].size() == 3);
  CHECK(whole["keyframes"].size() == read_trajectory(folder / "out/keyframes.txt").size());
  // The truth is moved to where the run is: close, but not the same.
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(whole["truth"][i][2].get<double>() ==
          doctest::Approx(whole["estimate"][i][2].get<double>()).epsilon(0.02));
  CHECK(whole["truth"] != whole["estimate"]);

  nlohmann::json metrics = read_json(folder / "out/metrics.json");
  metrics["dataset"]["path"] = "/no/such";
  folder.write("out/metrics.json", metrics.dump());
  const nlohmann::json moved = run_of(page_of({"--run", folder / "out"}));
  CHECK(moved["truth"].empty());
  CHECK(moved["estimate"] == whole["estimate"]);
  CHECK(moved["camera"]["width"] == 640);
}

TEST_CASE("export --web refuses what does not go with it") {
  const TemporaryFolder folder;
  write_map(folder / "map.ply", {});
  const auto message = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "export");
    const Outcome outcome = surefield_command(arguments, folder.path());
    CHECK(outcome.code == 2);
    return outcome.err;
  };
  const std::string map = folder / "map.ply", web = folder / "web";
  CHECK(contains(message({"--map", map, "--web", web, "--format", "spz"}), "--format requires --out"));
  CHECK(contains(message({"--map", map, "--web", web, "--out", folder / "a.ply"}), "--help"));
  CHECK(contains(message({"--mesh", map, "--web", web}), "excludes"));
  CHECK(contains(message({"--map", map}), "--help"));
  folder.write("file", "");
  CHECK(contains(message({"--map", map, "--web", folder / "file/web"}), "file/web: cannot be created"));
}

TEST_CASE("[slow] a browser shows on the web page what render renders, upright and unmirrored") {
  const TemporaryFolder folder;
  const std::string chromium = find_chromium();
  if (chromium.empty()) return;
  const Outcome run = surefield_command(short_run(folder / "out"), folder.path());
  REQUIRE_MESSAGE(run.code == 0, run.err);
  const Outcome page =
      surefield_command({"export", "--run", folder / "out", "--web", folder / "web"}, folder.path());
  REQUIRE_MESSAGE(page.code == 0, page.err);
  const View view(folder, run_of(read_file(folder / "web/index.html")), 2, 3);
  const Outcome render = surefield_command({"render", "--map", folder / "out/map.ply", "--camera",
                                            folder / "camera.json", "--out", folder / "view"},
                                           folder.path());
  REQUIRE_MESSAGE(render.code == 0, render.err);
  const cv::Mat shown = screenshot(
      chromium, folder, "file://" + (folder / "web/index.html").string() + view.address, view.size);
  cv::Mat rendered;
  cv::imread(folder / "view/colour.png").convertTo(rendered, CV_32FC3, 1.0 / 255);
  const cv::Mat opacity = read_tiff(folder / "view/opacity.tiff");
  const double closeness = interior_psnr(shown, rendered, opacity);
  MESSAGE("web page against render: ", closeness, " dB");
  CHECK(closeness >= 30);
  for (int axis : {-1, 0, 1}) {
    cv::Mat turned;
    cv::flip(shown, turned, axis);
    CHECK(interior_psnr(turned, rendered, opacity) < closeness - 10);
  }
}
