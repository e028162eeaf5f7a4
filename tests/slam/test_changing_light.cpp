// SLAM under a light, or an exposure, that changes: nothing is lost, and the map keeps one exposure.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "engine/eval/trajectory_metrics.h"
#include "engine/types/error.h"
#include "tests/slam/office.h"

using namespace surefield;
using namespace surefield::testing;

namespace {

constexpr int kFrames = 14;

/// The light of a frame, a factor a channel.
using Lighting = std::function<cv::Vec3d(int frame)>;

cv::Vec3d grey(double factor) {
  return {factor, factor, factor};
}

/// The frames of a walk through the office, in a steady light.
const SyntheticRecording& walk() {
  static const SyntheticRecording recording = office(kFrames);
  return recording;
}

Frame in_light(int i, const Lighting& light) {
  Frame frame = *walk().load(i).frame;
  frame.colour = frame.colour.clone();
  const cv::Vec3d factors = light(i);
  frame.colour.forEach<cv::Vec3b>([&](cv::Vec3b& pixel, const int*) {
    for (int c = 0; c < 3; ++c) pixel[c] = cv::saturate_cast<uint8_t>(factors[c] * pixel[c]);
  });
  return frame;
}

struct LitRun {
  Trajectory trajectory;
  std::vector<FrameReport> reports;
  std::vector<int> passed_over;
  cv::Vec3d brightness;  ///< of the final map from the last pose, over that of the frame in steady light

  int lost() const {
    return static_cast<int>(
        std::count_if(reports.begin(), reports.end(), [](const auto& r) { return r.lost(); }));
  }
  double ate() const { return evaluate_trajectory(trajectory, walk().ground_truth()).ate.rmse; }
};

LitRun run(const Lighting& light) {
  Slam slam(quick_settings(), walk().intrinsics(), engine_options());
  LitRun result;
  for (int i = 0; i < kFrames; ++i) {
    try {
      slam.feed(in_light(i, light));
    } catch (const NoImageError&) {
      result.passed_over.push_back(i);
    }
  }
  slam.finish();
  result.trajectory = slam.trajectory();
  result.reports = slam.reports();
  const RenderImages images =
      slam.render({walk().intrinsics(), result.trajectory.back().camera_to_world.inverse()});
  const cv::Scalar frame = cv::mean(in_light(kFrames - 1, [](int) { return grey(1); }).colour);
  for (std::size_t i = 0; i < images.colour.size(); ++i)
    result.brightness[static_cast<int>(i % 3)] += images.colour[i];
  for (int c = 0; c < 3; ++c) result.brightness[c] *= 255.0 / (images.width * images.height) / frame[c];
  return result;
}

/// Whether a map is as bright as these factors make the steady light.
void check_brightness(const LitRun& run, const cv::Vec3d& expected) {
  for (int c = 0; c < 3; ++c) {
    CAPTURE(c);
    CHECK(run.brightness[c] == doctest::Approx(expected[c]).epsilon(0.06));
  }
}

}  // namespace

TEST_CASE("[slow] a light that changes loses no frame, and the map has the exposure of most frames") {
  Lighting light;
  cv::Vec3d map = grey(1);
  SUBCASE("steady") {
    light = [](int) { return grey(1); };
  }
  SUBCASE("darker from a frame on") {
    light = [](int i) { return grey(i < 8 ? 1 : 0.6); };
  }
  SUBCASE("brighter from a frame on") {
    light = [](int i) { return grey(i < 8 ? 1 : 1.5); };
  }
  SUBCASE("darker soon, for good") {
    light = [](int i) { return grey(i < 2 ? 1 : 0.5); };
    map = grey(0.5);
  }
  SUBCASE("another white") {
    light = [](int i) { return i < 8 ? grey(1) : cv::Vec3d(1.3, 1, 0.7); };
  }
  SUBCASE("a flash of two frames") {
    light = [](int i) { return grey(i == 5 || i == 6 ? 2 : 1); };
  }
  SUBCASE("dark for a keyframe") {
    light = [](int i) { return grey(i == 6 ? 0.4 : 1); };
  }
  const LitRun result = run(light);
  CHECK(result.passed_over.empty());
  CHECK(result.lost() == 0);
  CHECK(result.ate() < 0.01);
  check_brightness(result, map);
}

TEST_CASE("a light that drifts a little with every frame loses none") {
  const LitRun result = run([](int i) { return grey(std::pow(0.9, std::max(0, i - 3))); });
  CHECK(result.passed_over.empty());
  CHECK(result.lost() == 0);
  CHECK(result.ate() < 0.01);
}

TEST_CASE("a run that fades in from black begins when the exposure has settled") {
  const LitRun result = run([](int i) { return grey(i < 5 ? i / 5.0 : 1); });
  CHECK(result.passed_over == std::vector{0, 1, 2, 3, 4, 5});
  REQUIRE(result.reports.size() == kFrames - 6);
  CHECK(result.reports[0].index == 6);
  CHECK(result.lost() == 0);
  CHECK(result.ate() < 0.01);
  check_brightness(result, grey(1));
}

TEST_CASE("a run that begins in the dark and becomes bright has a bright map") {
  const LitRun fade = run([](int i) { return grey(std::min(1.0, 0.12 + 0.3 * i)); });
  CHECK(fade.lost() == 0);
  check_brightness(fade, grey(1));
}

TEST_CASE("black frames in the middle are passed over, without a pose, and tracking goes on after them") {
  const LitRun result = run([](int i) { return grey(i >= 6 && i < 9 ? 0 : 1); });
  CHECK(result.passed_over == std::vector{6, 7, 8});
  CHECK(result.trajectory.size() == kFrames - 3);
  CHECK(result.lost() == 0);
  CHECK(result.ate() < 0.01);
  check_brightness(result, grey(1));
}

TEST_CASE("where the light is steady nothing depends on whether it is watched") {
  const auto bits = [](double correct_above) {
    SlamSettings settings = quick_settings();
    settings.light.correct_above = correct_above;
    Slam slam(settings, office_camera(), engine_options());
    for (const Frame& frame : office_frames()) slam.feed(frame);
    slam.finish();
    return slam.trajectory();
  };
  const Trajectory watched = bits(0.15), unwatched = bits(1e6);
  REQUIRE(watched.size() == unwatched.size());
  for (std::size_t i = 0; i < watched.size(); ++i) {
    CHECK(watched[i].camera_to_world.matrix() == unwatched[i].camera_to_world.matrix());
  }
}
