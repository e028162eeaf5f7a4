#include <cmath>
#include <opencv2/core.hpp>

#include "engine/formats/ply.h"
#include "engine/io/images.h"
#include "tests/tools/support.h"

using namespace surefield;
using namespace surefield::test;

namespace {

constexpr double kOpacity = 0.8;
constexpr const char* kCamera = R"({"width": 64, "height": 48, "fx": 50, "fy": 50, "cx": 32, "cy": 24,
  "world_to_camera": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]})";

/// Two small Gaussians: one red, 2 m ahead; one 4 m ahead, which is seen 20 pixels to the right.
GaussianCloud two_gaussians() {
  GaussianCloud cloud;
  cloud.resize(2);
  cloud.sh.assign(6, 0);
  cloud.means = {{0, 0, 2}, {1.6f, 0, 4}};
  for (int i = 0; i < 2; ++i) {
    cloud.log_scales[i].setConstant(std::log(0.04f));
    cloud.opacity_logits[i] = static_cast<float>(std::log(kOpacity / (1 - kOpacity)));
  }
  cloud.uncertainty = {0.04f, 0};
  constexpr float kDegreeZero = 0.28209479f;
  for (int c = 0; c < 3; ++c) cloud.sh[c] = ((c == 0 ? 1.0f : 0.0f) - 0.5f) / kDegreeZero;
  return cloud;
}

}  // namespace

TEST_CASE("render writes every output with the values that the formulas give") {
  const TemporaryFolder folder;
  write_ply(folder / "map.ply", two_gaussians());
  const auto camera = folder.write("camera.json", kCamera);
  write_png(folder / "depth.png", cv::Mat(48, 64, CV_16UC1, cv::Scalar(12500)));
  const auto view = folder / "view";
  const Outcome outcome =
      surefield_command({"render", "--map", folder / "map.ply", "--camera", camera, "--out", view,
                         "--sensor-depth", folder / "depth.png", "--depth-scale", "5000"},
                        folder.path());
  CHECK_MESSAGE(outcome.code == 0, outcome.err);
  const auto at = [&](const char* name, int u) {
    const cv::Mat image = read_tiff(view / (std::string(name) + ".tiff"));
    REQUIRE(image.size() == cv::Size(64, 48));
    return static_cast<double>(image.at<float>(24, u));
  };
  CHECK(at("opacity", 32) == doctest::Approx(kOpacity));
  CHECK(at("depth", 32) == doctest::Approx(kOpacity * 2));
  CHECK(at("depth_normalised", 32) == doctest::Approx(2));
  CHECK(at("depth_median", 32) == doctest::Approx(2));
  CHECK(at("uncertainty", 32) == doctest::Approx(kOpacity * 0.5 * 0.5));
  CHECK(at("dominator", 32) == 0);
  CHECK(at("dominator_weight", 32) == doctest::Approx(kOpacity));
  CHECK(at("dominator", 52) == 1);
  CHECK(at("depth_median", 52) == doctest::Approx(4));
  CHECK(at("gaussian_uncertainty", 32) == doctest::Approx(0.04));
  CHECK(at("gaussian_uncertainty", 52) == doctest::Approx(0));
  const cv::Mat shown = read_colour(view / "gaussian_uncertainty.png");
  CHECK(shown.at<cv::Vec3b>(24, 32) == cv::Vec3b(252, 255, 164));  // 20 cm, the end of the scale
  CHECK(shown.at<cv::Vec3b>(24, 52) == cv::Vec3b(0, 0, 4));
  CHECK(shown.at<cv::Vec3b>(24, 0) == cv::Vec3b(128, 128, 128));
  for (const char* name : {"opacity", "depth", "depth_normalised", "depth_median", "uncertainty",
                           "dominator_weight", "gaussian_uncertainty"}) {
    CHECK(at(name, 0) == 0);
  }
  CHECK(at("dominator", 0) == -1);
  const cv::Vec3f colour = read_tiff(view / "colour.tiff").at<cv::Vec3f>(24, 32);
  CHECK(colour[0] == doctest::Approx(kOpacity));
  CHECK(colour[1] == doctest::Approx(0));
  const cv::Vec3b screen = read_colour(view / "colour.png").at<cv::Vec3b>(24, 32);
  CHECK(screen == cv::Vec3b(204, 0, 0));
}

TEST_CASE("render --mode writes a picture of each mode that was asked for, and nothing else") {
  const TemporaryFolder folder;
  write_ply(folder / "map.ply", two_gaussians());
  const auto camera = folder.write("camera.json", kCamera);
  write_png(folder / "sensor.png", cv::Mat(48, 64, CV_8UC3, cv::Scalar(10, 20, 30)));
  const auto render = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"render", "--map", folder / "map.ply", "--camera", camera});
    return surefield_command(arguments, folder.path());
  };
  const Outcome all =
      render({"--out", folder / "all", "--mode", "all", "--sensor-colour", folder / "sensor.png"});
  CHECK_MESSAGE(all.code == 0, all.err);
  std::size_t written = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder.path() / "all"))
    written += file.path().extension() == ".png";
  CHECK(written == 10);  // all but the uncertainty of the depth, for which there is no depth
  // Red at an opacity of 0.8, and behind it a square of the darker tone, (41, 41, 43).
  CHECK(read_colour(folder / "all/colour.png").at<cv::Vec3b>(24, 32) == cv::Vec3b(212, 8, 9));
  CHECK(read_colour(folder / "all/sensor.png").at<cv::Vec3b>(24, 32) == cv::Vec3b(10, 20, 30));
  CHECK(read_colour(folder / "all/opacity.png").at<cv::Vec3b>(24, 32) == cv::Vec3b(204, 204, 204));

  const Outcome two =
      render({"--out", folder / "two", "--mode", "points", "--mode", "median-depth", "--far", "2"});
  CHECK_MESSAGE(two.code == 0, two.err);
  CHECK(std::filesystem::exists(folder.path() / "two/points.png"));
  CHECK_FALSE(std::filesystem::exists(folder.path() / "two/colour.png"));
  CHECK(read_colour(folder / "two/median-depth.png").at<cv::Vec3b>(24, 32) == cv::Vec3b(122, 4, 3));

  const Outcome without = render({"--out", folder / "no", "--mode", "error"});
  CHECK(without.code == 2);
  CHECK(contains(without.err, "--mode error needs --sensor-colour"));
}

TEST_CASE("render of a run takes the depth model of the run") {
  const TemporaryFolder folder;
  GaussianCloud disc = two_gaussians();
  disc.log_scales[0] = {std::log(0.4f), std::log(0.4f), std::log(0.01f)};
  disc.rotations[0] = {std::cos(0.4f), 0, std::sin(0.4f), 0};  // turned, so that its depth changes along u
  const auto camera = folder.write("camera.json", kCamera);
  std::filesystem::create_directories(folder.path() / "run");
  write_ply(folder / "run/map.ply", disc);
  folder.write("run/metrics.json", R"({"schema": "surefield-metrics", "version": 1, "per_frame": []})");
  folder.write("run/trajectory.txt", "");
  folder.write("run/keyframes.txt", "");
  const auto depth_right_of_centre = [&](const char* model) {
    folder.write("run/config.yaml", std::string("depth_model: ") + model + "\n");
    const Outcome outcome = surefield_command(
        {"render", "--run", folder / "run", "--camera", camera, "--out", folder / model}, folder.path());
    CHECK_MESSAGE(outcome.code == 0, outcome.err);
    const cv::Mat image = read_tiff(folder.path() / model / "depth_normalised.tiff");
    REQUIRE(image.size() == cv::Size(64, 48));
    return static_cast<double>(image.at<float>(24, 36));
  };
  CHECK(depth_right_of_centre("centre") == doctest::Approx(2));
  CHECK(std::abs(depth_right_of_centre("plane") - 2) > 0.1);
}

TEST_CASE("render refuses input that does not fit") {
  const TemporaryFolder folder;
  write_ply(folder / "map.ply", two_gaussians());
  const auto camera = folder.write("camera.json", kCamera);
  write_png(folder / "small.png", cv::Mat(10, 10, CV_16UC1, cv::Scalar(1)));
  const auto message = [&](const std::string& map, const std::string& scale) {
    const Outcome outcome =
        surefield_command({"render", "--map", map, "--camera", camera, "--out", folder / "view",
                           "--sensor-depth", folder / "small.png", "--depth-scale", scale},
                          folder.path());
    CHECK(outcome.code == 2);
    return outcome.err;
  };
  CHECK(contains(message(folder / "map.ply", "5000"), "small.png: is 10 x 10, but the camera is 64 x 48"));
  CHECK(contains(message(folder / "map.ply", "0.0002"), "no number of steps per metre"));
  CHECK_FALSE(std::filesystem::exists(folder / "view"));
}
