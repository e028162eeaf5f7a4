#include "engine/synth/synthetic_recording.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/types/error.h"
#include "tests/support/device.h"

using namespace surefield;
using Eigen::Vector3d;

namespace {

SyntheticRecording make(const SynthSettings& settings) {
  return SyntheticRecording(testing::device_options(), settings);
}

/// What remains after pixels of one frame are moved into another one by the true poses.
struct WarpResiduals {
  std::vector<double>
      depth;  ///< |measured - predicted| in metres, pixels hidden in the second frame left out
  std::vector<double> colour;  ///< mean over the channels, in 8-bit steps
  int hidden = 0;              ///< pixels whose place in the second frame shows something else
};

/// 1 / (interpolated inverse depth): exact on planes, whose inverse depth is linear in the image. 0 where the
/// four neighbours do not lie on one surface.
double interpolated_depth(const cv::Mat& depth, double u, double v) {
  const int x = static_cast<int>(u), y = static_cast<int>(v);
  const double a = depth.at<float>(y, x), b = depth.at<float>(y, x + 1);
  const double c = depth.at<float>(y + 1, x), d = depth.at<float>(y + 1, x + 1);
  if (std::max({a, b, c, d}) - std::min({a, b, c, d}) > 0.05 * a) return 0;
  return 1 / std::lerp(std::lerp(1 / a, 1 / b, u - x), std::lerp(1 / c, 1 / d, u - x), v - y);
}

WarpResiduals warp(const SyntheticRecording& recording, int from, int to) {
  const Frame source = *recording.load(from).frame, target = *recording.load(to).frame;
  const Trajectory& truth = recording.ground_truth();
  const Pose motion = truth[to].camera_to_world.inverse() * truth[from].camera_to_world;
  const Intrinsics k = recording.intrinsics();
  WarpResiduals residuals;
  for (int v = 0; v < k.height; ++v) {
    for (int u = 0; u < k.width; ++u) {
      const double z = source.depth.at<float>(v, u);
      const Vector3d moved = motion * Vector3d((u - k.cx) / k.fx * z, (v - k.cy) / k.fy * z, z);
      const double x = k.fx * moved.x() / moved.z() + k.cx, y = k.fy * moved.y() / moved.z() + k.cy;
      if (!(x >= 0 && y >= 0 && x < k.width - 1 && y < k.height - 1)) continue;
      const double measured = interpolated_depth(target.depth, x, y);
      if (measured < 0.95 * moved.z()) {
        ++residuals.hidden;
        continue;
      }
      residuals.depth.push_back(std::abs(measured - moved.z()));
      const auto& before = source.colour.at<cv::Vec3b>(v, u);
      const auto& after = target.colour.at<cv::Vec3b>(cvRound(y), cvRound(x));
      residuals.colour.push_back(cv::norm(cv::Vec3d(before) - cv::Vec3d(after), cv::NORM_L1) / 3);
    }
  }
  return residuals;
}

double percentile(std::vector<double> values, double fraction) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

TEST_CASE("the true poses carry the pixels of a frame onto the same surfaces five frames later") {
  const SyntheticRecording recording = make({.width = 160, .height = 120});
  const WarpResiduals residuals = warp(recording, 10, 15);
  const double total = 160.0 * 120.0;
  CHECK(static_cast<double>(residuals.depth.size()) > 0.75 * total);
  CHECK(residuals.hidden < 0.1 * total);
  CHECK(percentile(residuals.depth, 0.5) < 1e-5);
  CHECK(percentile(residuals.depth, 0.9) < 4e-3);
  CHECK(percentile(residuals.colour, 0.5) < 6);
}

TEST_CASE("a frame at 640 x 480 warped into the tenth after it meets the surfaces within half a millimetre") {
  const SyntheticRecording recording = make({.width = 640, .height = 480, .frames = 11});
  CHECK(percentile(warp(recording, 0, 10).depth, 0.5) < 0.0005);
}

TEST_CASE("the frames are textured and neither dark nor burnt out") {
  const SyntheticRecording recording = make({.width = 160, .height = 120});
  for (const int i : {0, 59}) {
    const Frame frame = *recording.load(i).frame;
    cv::Scalar mean, deviation;
    cv::meanStdDev(frame.colour, mean, deviation);
    for (int c = 0; c < 3; ++c) {
      CHECK(mean[c] > 50);
      CHECK(mean[c] < 200);
      CHECK(deviation[c] > 20);
    }
    CHECK(cv::countNonZero((frame.depth > 0.3) & (frame.depth < 9)) == 160 * 120);
  }
}

TEST_CASE("frames, stamps and the true trajectory agree") {
  const SyntheticRecording recording = make({.width = 32, .height = 24, .frames = 4, .seed = 7});
  CHECK(recording.count() == 4);
  CHECK(recording.intrinsics().cx == doctest::Approx(15.5));
  REQUIRE(recording.ground_truth().size() == 4);
  for (int i = 0; i < recording.count(); ++i) {
    const LoadedFrame loaded = recording.load(i);
    REQUIRE(loaded.frame.has_value());
    CHECK(loaded.problem.empty());
    CHECK(loaded.frame->index == i);
    CHECK(loaded.frame->timestamp == recording.timestamp(i));
    CHECK(loaded.frame->colour.size() == cv::Size(32, 24));
    CHECK(recording.ground_truth().at(i).timestamp == recording.timestamp(i));
    CHECK(recording.ground_truth().at(i).is_finite());
  }
}

TEST_CASE("views beside the path are 10 cm and 4 degrees off it, ideal, and see something") {
  const SynthSettings settings{.width = 64, .height = 48, .frames = 30, .sensor = SensorKind::Kinect};
  const SyntheticRecording path = make(settings);
  SynthSettings other = settings;
  other.beside = 5;
  const SyntheticRecording beside = make(other);
  REQUIRE(beside.count() == 5);
  REQUIRE(beside.ground_truth().size() == 5);
  for (int i = 0; i < 5; ++i) {
    CAPTURE(i);
    const Pose there = beside.ground_truth()[i].camera_to_world, here = path.true_pose((i + 0.5) / 5);
    CHECK((there.translation() - here.translation()).norm() == doctest::Approx(0.1));
    const Eigen::AngleAxisd turn((there.linear().transpose() * here.linear()).eval());
    CHECK(turn.angle() == doctest::Approx(4 * std::numbers::pi / 180));
    CHECK(beside.true_pose(beside.timestamp(i)).matrix() == there.matrix());
    CHECK(beside.colour_timestamp(i) == beside.timestamp(i));
    const Frame frame = *beside.load(i).frame;
    CHECK(cv::countNonZero(frame.depth) == frame.depth.rows * frame.depth.cols);
  }
  CHECK_THROWS_AS(make({.width = 8, .height = 8, .frames = 1, .beside = -1}), InputError);
}

TEST_CASE("a sequence without pixels or frames is refused") {
  CHECK_THROWS_AS(make({.width = 0}), InputError);
  CHECK_THROWS_AS(make({.frames = 0}), InputError);
  CHECK_THROWS_AS(make({.scene = "moon"}), InputError);
  CHECK_THROWS_AS(make({.path = "drunk"}), InputError);
}
