#include "engine/eval/image_metrics.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "engine/io/error.h"

using namespace surefield;

TEST_CASE("PSNR of known differences") {
  const cv::Mat black(4, 5, CV_32FC3, cv::Scalar::all(0));
  const cv::Mat tenth(4, 5, CV_32FC3, cv::Scalar::all(0.1));
  CHECK(psnr(black, tenth) == doctest::Approx(20.0));
  CHECK(psnr(tenth, black) == psnr(black, tenth));
  // One channel of one of 20 pixels is off by 1: the mean over 60 values is 1 / 60.
  cv::Mat one = black.clone();
  one.at<cv::Vec3f>(2, 3)[1] = 1;
  CHECK(psnr(one, black) == doctest::Approx(10 * std::log10(60.0)));
  CHECK(psnr(cv::Mat(1, 1, CV_32FC1, cv::Scalar(1)), cv::Mat(1, 1, CV_32FC1, cv::Scalar(0))) == 0);
  CHECK(std::isinf(psnr(black, black)));
}

TEST_CASE("images that cannot be compared are refused") {
  const cv::Mat image(4, 5, CV_32FC3, cv::Scalar::all(0));
  CHECK_THROWS_AS(psnr(image, cv::Mat(5, 4, CV_32FC3)), InputError);
  CHECK_THROWS_AS(psnr(image, cv::Mat(4, 5, CV_32FC1)), InputError);
  CHECK_THROWS_AS(psnr(cv::Mat(4, 5, CV_8UC3), cv::Mat(4, 5, CV_8UC3)), InputError);
  CHECK_THROWS_AS(psnr(cv::Mat(), cv::Mat()), InputError);
  cv::Mat broken = image.clone();
  broken.at<cv::Vec3f>(0, 0)[0] = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_AS(psnr(broken, image), InputError);
}
