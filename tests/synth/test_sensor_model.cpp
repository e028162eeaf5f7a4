#include "engine/synth/sensor_model.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "engine/synth/synthetic_recording.h"
#include "tests/support/device.h"

using namespace surefield;

namespace {

constexpr Intrinsics kCamera{320, 240, 272, 272, 159.5, 119.5};

cv::Mat flat(double z) {
  return cv::Mat(240, 320, CV_32FC1, cv::Scalar(z));
}

struct Statistics {
  double mean = 0, deviation = 0;
};

Statistics statistics(const cv::Mat& values) {
  cv::Scalar mean, deviation;
  cv::meanStdDev(values, mean, deviation);
  return {mean[0], deviation[0]};
}

/// Metres between two steps of disparity at depth z.
double step_at(double z) {
  return z * z / (640.0 * 272 / 320 * 0.075 * 8);
}

}  // namespace

TEST_CASE("depth noise has the standard deviation of its formula, rounding to steps of disparity included") {
  KinectModel fine;
  fine.disparity_step = 1e-6;  // as good as none
  const KinectModel kinect;
  for (const double z : {0.6, 1.5, 3.0, 4.2}) {
    CAPTURE(z);
    const double sigma = 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4);
    const Statistics noise = statistics(fine.depth(flat(z), kCamera, 0));
    CHECK(std::abs(noise.mean - z) < 4 * sigma / std::sqrt(76800.0) + 1e-5);
    CHECK(noise.deviation == doctest::Approx(sigma).epsilon(0.02));
    // Rounding adds the variance of a uniform step where the noise is wider than it.
    const Statistics stepped = statistics(kinect.depth(flat(z), kCamera, 0));
    const double step = step_at(z);
    if (sigma > 0.5 * step)
      CHECK(stepped.deviation == doctest::Approx(std::hypot(sigma, step / std::sqrt(12.0))).epsilon(0.05));
    CHECK(std::abs(stepped.mean - z) < step);
  }
}

TEST_CASE("measured disparities are multiples of an eighth of a pixel") {
  const cv::Mat depth = KinectModel().depth(flat(2), kCamera, 3);
  const double focal = 640.0 * 272 / 320;
  for (int i = 0; i < 320; ++i) {
    const double eighths = 8 * focal * 0.075 / depth.at<float>(120, i);
    CHECK(std::abs(eighths - std::round(eighths)) < 1e-3);
  }
}

TEST_CASE("there is no depth out of range, at edges and at grazing angles") {
  const KinectModel kinect;
  CHECK(cv::countNonZero(kinect.depth(flat(0.35), kCamera, 0)) == 0);
  CHECK(cv::countNonZero(kinect.depth(flat(4.6), kCamera, 0)) == 0);
  CHECK(cv::countNonZero(kinect.depth(flat(0), kCamera, 0)) == 0);

  cv::Mat edge = flat(2);
  edge.colRange(100, 320).setTo(1.5);
  const cv::Mat seen = kinect.depth(edge, kCamera, 0);
  CHECK(cv::countNonZero(seen) == 240 * 318);
  CHECK(cv::countNonZero(seen.colRange(99, 101)) == 0);

  // A floor 1 m below a level camera. In the middle of row v its cosine is s / sqrt(1 + s^2) with
  // s = (v - cy) / f, which is 0.3 in row 205.
  cv::Mat floor = cv::Mat::zeros(240, 320, CV_32FC1);
  for (int v = 125; v < 240; ++v) floor.row(v).setTo(272 / (v - 119.5));
  KinectModel strict;
  strict.grazing_cosine = 0.3;
  strict.edge_step = 10;
  const cv::Mat near_part = strict.depth(floor, kCamera, 0);
  CHECK(cv::countNonZero(near_part.rowRange(0, 203)) == 0);
  CHECK(cv::countNonZero(near_part(cv::Rect(150, 207, 20, 31))) == 31 * 20);
}

TEST_CASE("noise depends on seed and frame alone") {
  KinectModel one, two;
  two.seed = 2;
  const auto same = [](const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF) == 0; };
  const cv::Mat depth = one.depth(flat(2), kCamera, 5);
  CHECK(same(depth, one.depth(flat(2), kCamera, 5)));
  CHECK_FALSE(same(depth, one.depth(flat(2), kCamera, 6)));
  CHECK_FALSE(same(depth, two.depth(flat(2), kCamera, 5)));
}

TEST_CASE("colour noise has its standard deviation and does not shift the mean") {
  const KinectModel kinect;
  cv::Mat colour(240, 320, CV_8UC3, cv::Scalar(100, 100, 100));
  kinect.add_colour_noise(colour, 1);
  std::vector<cv::Mat> channels;
  cv::split(colour, channels);
  for (const cv::Mat& channel : channels) {
    const Statistics noise = statistics(channel);
    CHECK(noise.mean == doctest::Approx(100).epsilon(0.001));
    // 1/12 is the variance of rounding to whole steps.
    CHECK(noise.deviation == doctest::Approx(std::sqrt(1.44 + 0.0121 * 100 + 1 / 12.0)).epsilon(0.02));
  }
  cv::Mat red;
  cv::multiply(channels[0], channels[1], red, 1, CV_32F);
  CHECK(std::abs(cv::mean(red)[0] - 10000) < 5);  // the channels are independent
}

TEST_CASE("exposure drifts within its bounds") {
  const KinectModel kinect;
  double least = 2, most = 0;
  for (double t = 0; t < 9; t += 0.1) {
    least = std::min(least, kinect.brightness(t));
    most = std::max(most, kinect.brightness(t));
  }
  CHECK(least == doctest::Approx(0.88).epsilon(0.01));
  CHECK(most == doctest::Approx(1.12).epsilon(0.01));
}

TEST_CASE("exposure jumps down or up at its time, or fades in over twelve frames") {
  KinectModel kinect;
  kinect.exposure_drift = 0;
  kinect.course = ExposureCourse::Jump;
  kinect.jump_seconds = 2;
  CHECK(kinect.brightness(1.99) == 1);
  CHECK(kinect.brightness(2) == doctest::Approx(0.35));
  kinect.course = ExposureCourse::Double;
  CHECK(kinect.brightness(1.99) == 1);
  CHECK(kinect.brightness(2) == doctest::Approx(2));
  kinect.course = ExposureCourse::FadeIn;
  CHECK(kinect.brightness(0) == 0);
  CHECK(kinect.brightness(6 / 30.0) == doctest::Approx(0.5));
  CHECK(kinect.brightness(12 / 30.0) == doctest::Approx(1));
  CHECK(kinect.brightness(5) == 1);
}

TEST_CASE("depth that is read row by row has each row from where the camera is then") {
  SynthSettings settings{.path = "fast", .width = 160, .height = 120, .frames = 20};
  settings.sensor = SensorKind::Kinect;
  settings.kinect.disparity_step = 1e-5;  // no rounding
  const SyntheticRecording at_once(testing::device_options(), settings);
  settings.kinect.depth_readout_seconds = 0.03;
  const SyntheticRecording by_rows(testing::device_options(), settings);
  const cv::Mat a = at_once.load(10).frame->depth, b = by_rows.load(10).frame->depth;
  const auto difference = [&](int row) {
    cv::Mat apart;
    cv::absdiff(a.rowRange(row, row + 2), b.rowRange(row, row + 2), apart);
    const cv::Mat both = (a.rowRange(row, row + 2) > 0) & (b.rowRange(row, row + 2) > 0);
    REQUIRE(cv::countNonZero(both) > 50);
    return cv::mean(apart, both)[0];
  };
  CHECK(difference(59) < 0.2 * difference(0));
  CHECK(difference(59) < 0.2 * difference(118));
  CHECK(difference(0) > 0.005);
}

TEST_CASE("a fast camera blurs what a perfect one shows sharp, and its depth has holes and noise") {
  SynthSettings settings{.path = "fast", .width = 160, .height = 120, .frames = 20};
  const SyntheticRecording perfect(testing::device_options(), settings);
  settings.sensor = SensorKind::Kinect;
  const SyntheticRecording kinect(testing::device_options(), settings);
  const Frame sharp = perfect.load(10).frame.value(), blurred = kinect.load(10).frame.value();
  const int missing = 160 * 120 - cv::countNonZero(blurred.depth);
  CHECK(missing > 100);
  CHECK(missing < 0.8 * 160 * 120);
  const cv::Mat there = blurred.depth > 0;
  const double error = cv::norm(sharp.depth, blurred.depth, cv::NORM_L1, there) / cv::countNonZero(there);
  CHECK(error > 0.002);
  CHECK(error < 0.05);
  CHECK(cv::norm(sharp.colour, blurred.colour, cv::NORM_L1) > 3.0 * 160 * 120);
}
