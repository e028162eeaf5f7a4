#include "engine/eval/space_metrics.h"

#include <doctest/doctest.h>

#include <limits>

#include "engine/types/error.h"

using namespace surefield;

namespace {

const DepthNoise kKinect = noise_of(DepthSensor::StructuredLight);

}  // namespace

TEST_CASE(
    "a surface floats where the sensor saw well past it: 5 cm, or three deviations of what it measured") {
  CHECK_FALSE(sees_through(1.96, 2, kKinect));
  CHECK(sees_through(1.94, 2, kKinect));
  CHECK_FALSE(sees_through(2.5, 2, kKinect));  // behind what was measured
  const double far = 8, deviation = kKinect.sigma(far);
  CHECK_FALSE(sees_through(far - 2.9 * deviation, far, kKinect));
  CHECK(sees_through(far - 3.1 * deviation, far, kKinect));
}

TEST_CASE("covered and floating pixels are counted among those with depth") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  //                                              hit   floats  thin  behind  none  unknown
  const cv::Mat sensor = (cv::Mat_<float>(1, 6) << 2.0f, 2.0f, 2.0f, 2.0f, 0.0f, nan);
  const cv::Mat opacity = (cv::Mat_<float>(1, 6) << 0.9f, 0.6f, 0.5f, 1.0f, 1.0f, 1.0f);
  const cv::Mat depth = (cv::Mat_<float>(1, 6) << 2.0f, 1.0f, 1.0f, 3.0f, 1.0f, 1.0f);
  SpaceCounts counts = count_space(opacity, depth, sensor, kKinect);
  CHECK(counts.valid == 4);
  CHECK(counts.covered == 3);
  CHECK(counts.floating == 1);
  CHECK(counts.coverage() == 0.75);
  CHECK(counts.floaters() == 0.25);
  counts += count_space(opacity, depth, sensor, kKinect);
  CHECK(counts.valid == 8);
  CHECK(counts.floaters() == 0.25);
}

TEST_CASE("without depth nothing floats; images that do not match are refused") {
  const cv::Mat none = cv::Mat::zeros(2, 3, CV_32FC1), some(2, 3, CV_32FC1, cv::Scalar(1));
  CHECK(count_space(some, some, none, kKinect).floaters() == 0);
  CHECK(count_space(some, some, none, kKinect).coverage() == 0);
  CHECK_THROWS_AS(count_space(some, some, cv::Mat::zeros(3, 2, CV_32FC1), kKinect), InputError);
  CHECK_THROWS_AS(count_space(some, cv::Mat(), none, kKinect), InputError);
}
