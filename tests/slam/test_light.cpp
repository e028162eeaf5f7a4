#include <doctest/doctest.h>

#include <cmath>

#include "engine/slam/first_light.h"
#include "engine/slam/light.h"

using namespace surefield;

namespace {

constexpr int kWidth = 160, kHeight = 120;
const Intrinsics kIntrinsics{kWidth, kHeight, 130, 130, 79.5, 59.5};

/// What a camera that has moved along x by `shift` metres sees of a wall of blurred patches, 2 m away.
Frame wall(double shift = 0) {
  Frame frame;
  frame.colour = cv::Mat(kHeight, kWidth, CV_8UC3);
  frame.depth = cv::Mat(kHeight, kWidth, CV_32FC1, cv::Scalar(2));
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) {
      const double x = u + shift * 130 / 2;
      for (int c = 0; c < 3; ++c)
        frame.colour.at<cv::Vec3b>(v, u)[c] =
            static_cast<uint8_t>(100 + 45 * std::sin(0.11 * x + c) + 40 * std::cos(0.09 * v + 2 * c));
    }
  return frame;
}

Frame in_light(const Frame& frame, const Eigen::Vector3f& gains) {
  Frame lit = frame;
  lit.colour = apply_gains(frame.colour, gains);
  return lit;
}

Camera camera_at(double shift) {
  Camera camera{kIntrinsics, Pose::Identity()};
  camera.world_to_camera.translation().x() = -shift;
  return camera;
}

/// The gains found for `frame`, thought to be taken at `shift`, by a wall's keyframe of these gains.
Eigen::Vector3f found(const Frame& frame, double shift = 0,
                      const Eigen::Vector3f& before = Eigen::Vector3f::Ones(),
                      const Eigen::Vector3f& reference_gains = Eigen::Vector3f::Ones()) {
  const ColourGrid keyframe = make_colour_grid(wall());
  const std::vector<LitView> references{{keyframe, reference_gains, camera_at(0)}};
  return find_gains(make_colour_grid(frame), camera_at(shift), references, before, 0.15);
}

}  // namespace

TEST_CASE("a grid has the means and the peaks of cells, and a depth") {
  Frame frame = wall();
  frame.colour(cv::Rect(8, 4, 4, 4)) = cv::Scalar(10, 20, 30);
  frame.colour.at<cv::Vec3b>(5, 9) = cv::Vec3b(26, 20, 255);
  frame.depth.at<float>(6, 10) = 0;
  const ColourGrid grid = make_colour_grid(frame);
  CHECK(grid.cell == 4);
  REQUIRE(grid.width == 40);
  REQUIRE(grid.height == 30);
  CHECK(grid.colour[42].isApprox(Eigen::Vector3f(11, 20, 30 + 225 / 16.0f)));
  CHECK(grid.peak[42] == Eigen::Vector3f(26, 20, 255));
  CHECK(grid.depth[42] == 0);
  CHECK(grid.depth[43] == 2);
}

TEST_CASE("gains are found where the light has changed, a channel each, from a camera that has moved") {
  for (const Eigen::Vector3f& light : {Eigen::Vector3f(0.6f, 0.6f, 0.6f), Eigen::Vector3f(1.3f, 1, 0.75f),
                                       Eigen::Vector3f(1.7f, 1.7f, 1.7f)}) {
    const Eigen::Vector3f gains = found(in_light(wall(0.2), light), 0.2);
    CAPTURE(gains.transpose());
    CHECK((gains.cwiseProduct(light) - Eigen::Vector3f::Ones()).cwiseAbs().maxCoeff() < 0.02f);
  }
  const Eigen::Vector3f half = Eigen::Vector3f::Constant(0.5f);
  CHECK(found(wall(), 0, Eigen::Vector3f::Ones(), half).isApprox(half, 0.02f));
}

TEST_CASE("a steady light has gains of exactly 1, and so has one that wanders by a few percent") {
  CHECK(found(wall(0.2), 0.2) == Eigen::Vector3f::Ones());
  for (float light : {0.9f, 0.95f, 1.05f, 1.1f})
    CHECK(found(in_light(wall(0.1), Eigen::Vector3f::Constant(light)), 0.1) == Eigen::Vector3f::Ones());
}

TEST_CASE("where the light is back the gains are 1 again") {
  const Eigen::Vector3f before = Eigen::Vector3f::Constant(1.3f);
  CHECK(found(wall(), 0, before) == Eigen::Vector3f::Ones());
}

TEST_CASE("what cannot be compared leaves the gains of the frame before") {
  const Eigen::Vector3f before(1.3f, 1.2f, 1.1f);
  Frame other = wall();
  SUBCASE("another surface") {
    other.depth.setTo(3);
  }
  SUBCASE("no depth") {
    other.depth.setTo(0);
  }
  SUBCASE("saturated") {
    other.colour.setTo(cv::Scalar::all(255));
  }
  SUBCASE("darker here and brighter there") {
    other.colour.forEach<cv::Vec3b>([&](cv::Vec3b& pixel, const int* at) {
      const uint32_t patch = static_cast<uint32_t>(at[0] / 12 * 100 + at[1] / 12) * 2654435761u >> 20;
      for (int c = 0; c < 3; ++c)
        pixel[c] = cv::saturate_cast<uint8_t>(pixel[c] * (patch % 5 < 3 ? 0.6 : 1.25));
    });
  }
  CHECK(found(other, 0, before) == before);
}

TEST_CASE("saturated pixels of a bright frame do not make it look darker than it is") {
  const Frame bright = in_light(wall(), Eigen::Vector3f::Constant(2));
  CHECK(found(bright).isApprox(Eigen::Vector3f::Constant(0.5f), 0.02f));
}

TEST_CASE("where a darkened frame was saturated it is as bright as the map, and not darker than it was") {
  const Eigen::Vector3f gains(0.5f, 0.5f, 1);
  cv::Mat colour = apply_gains(cv::Mat(1, 4, CV_8UC3, cv::Scalar(255, 100, 255)), gains);
  CHECK(has_saturated(colour, gains));
  RenderImages rendered{.width = 4, .height = 1};
  rendered.opacity = {1, 1, 0.5f, 1};
  for (float value : {0.8f, 0.3f, 0.8f, 2.0f}) rendered.colour.insert(rendered.colour.end(), 3, value);
  brighten_saturated(colour, rendered, gains);
  CHECK(colour.at<cv::Vec3b>(0, 0) == cv::Vec3b(204, 50, 255));
  CHECK(colour.at<cv::Vec3b>(0, 1) == cv::Vec3b(128, 50, 255));
  CHECK(colour.at<cv::Vec3b>(0, 2) == cv::Vec3b(128, 50, 255));
  CHECK(colour.at<cv::Vec3b>(0, 3) == cv::Vec3b(255, 50, 255));
  CHECK_FALSE(has_saturated(colour, Eigen::Vector3f::Ones()));
}

TEST_CASE("scaling the colours of Gaussians scales what they show") {
  GaussianCloud cloud;
  cloud.sh_degree = 1;
  cloud.resize(1);
  const float base = 0.28209479177387814f;
  cloud.sh = {0.2f / base, 0, -0.5f / base, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  scale_colours(cloud, Eigen::Vector3f(2, 0.5f, 3));
  CHECK(0.5f + base * cloud.sh[0] == doctest::Approx(1.4));
  CHECK(0.5f + base * cloud.sh[1] == doctest::Approx(0.25));
  CHECK(0.5f + base * cloud.sh[2] == doctest::Approx(0).epsilon(1e-6));
  CHECK(cloud.sh[3] == 2);
  CHECK(cloud.sh[10] == 4);
}

namespace {

/// Which frames of an image in these lights are passed over.
std::vector<bool> passed_over(const std::vector<float>& lights) {
  FirstLight first_light;
  std::vector<bool> passed;
  bool begun = false;
  for (float light : lights) {
    const Frame frame = in_light(wall(), Eigen::Vector3f::Constant(light));
    passed.push_back(first_light.objection(frame, make_colour_grid(frame), begun).has_value());
    begun = begun || !passed.back();
  }
  return passed;
}

}  // namespace

TEST_CASE("images that show nothing are passed over, and at the beginning those until the light is steady") {
  CHECK(passed_over({1, 1, 0.5f, 1}) == std::vector{false, false, false, false});
  CHECK(passed_over({1, 0, 0.02f, 1, 0.5f, 1}) == std::vector{false, true, true, false, false, false});
  CHECK(passed_over({0, 0.3f, 0.6f, 0.9f, 0.9f, 0.5f}) == std::vector{true, true, true, true, false, false});
  CHECK(passed_over({0, 1, 1, 1}) == std::vector{true, true, false, false});
  CHECK(passed_over({1, 20, 1}) == std::vector{false, true, false});
  CHECK(passed_over({20, 1.3f, 1.1f, 1, 1}) == std::vector{true, true, true, true, false});
}

TEST_CASE("a run does not wait for a steady light for ever") {
  std::vector<float> lights{0};
  for (int i = 0; i < 40; ++i) lights.push_back(i % 2 ? 0.5f : 1.0f);
  const std::vector<bool> passed = passed_over(lights);
  CHECK(passed[30]);
  CHECK_FALSE(passed[31]);
  CHECK_FALSE(passed[32]);
}
