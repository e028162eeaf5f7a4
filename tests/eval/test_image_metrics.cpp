#include "engine/eval/image_metrics.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

#include "engine/types/error.h"
#include "tests/reference/losses.h"

using namespace surefield;

namespace {

/// Noise in [0, 1], as an image and as the reference's plain numbers.
struct Noise {
  cv::Mat image;
  std::vector<double> values;

  Noise(int width, int height, uint32_t seed) : image(height, width, CV_32FC3) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (std::size_t i = 0; i < 3 * image.total(); ++i) {
      image.ptr<float>()[i] = uniform(random);
      values.push_back(image.ptr<float>()[i]);
    }
  }
};

}  // namespace

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

  // Over the pixels of a mask alone.
  cv::Mat mask(one.size(), CV_8UC1, cv::Scalar(0));
  CHECK_FALSE(psnr(one, black, mask).has_value());
  mask.setTo(1);
  CHECK(*psnr(one, black, mask) == doctest::Approx(psnr(one, black)));
  mask.at<uint8_t>(0, 0) = 0;
  CHECK(*psnr(one, black, mask) != doctest::Approx(psnr(one, black)));
  CHECK_THROWS_AS(psnr(one, black, cv::Mat(1, 1, CV_8UC1)), InputError);
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

TEST_CASE("SSIM equals the double-precision reference, borders included") {
  for (const cv::Size size : {cv::Size(23, 17), cv::Size(4, 3)}) {
    const Noise a(size.width, size.height, 1), b(size.width, size.height, 2);
    const double expected = reference::ssim(size.width, size.height, a.values, b.values).value;
    CHECK(ssim(a.image, b.image) == doctest::Approx(expected).epsilon(1e-9));
    CHECK(ssim(a.image, a.image) == doctest::Approx(1));
  }
}

TEST_CASE("SSIM of one pixel, by hand") {
  // Only the middle of the window sees the pixel: weight w = g^2, g the middle of the normalised 1D window.
  double sum = 0;
  for (int i = -5; i <= 5; ++i) sum += std::exp(-i * i / 4.5);
  const double w = 1 / (sum * sum);
  const double x = 0.5, y = 0.25, c1 = 1e-4, c2 = 9e-4;
  const double mx = w * x, my = w * y;
  const double luminance = (2 * mx * my + c1) / (mx * mx + my * my + c1);
  const double covariance = w * x * y - mx * my;
  const double variances = w * x * x - mx * mx + w * y * y - my * my;
  const cv::Mat first(1, 1, CV_32FC1, cv::Scalar(x)), second(1, 1, CV_32FC1, cv::Scalar(y));
  CHECK(ssim(first, second) == doctest::Approx(luminance * (2 * covariance + c2) / (variances + c2)));
}

TEST_CASE("depth L1 takes valid sensor depth only, and a hole in the map costs its depth") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  //                    hit   off by 0.1  hole  no depth  far   unknown
  const cv::Mat sensor = (cv::Mat_<float>(1, 6) << 1.0f, 2.0f, 3.0f, 0.0f, 9.0f, nan);
  const cv::Mat render = (cv::Mat_<float>(1, 6) << 1.0f, 2.1f, 0.0f, 5.0f, 1.0f, 1.0f);
  CHECK(depth_l1(render, sensor).value() == doctest::Approx((0.1 + 3.0 + 8.0) / 4));
  CHECK_FALSE(depth_l1(render, cv::Mat::zeros(1, 6, CV_32FC1)).has_value());
  CHECK_THROWS_AS(depth_l1(sensor, render), InputError);
  CHECK_THROWS_AS(depth_l1(cv::Mat::zeros(2, 6, CV_32FC1), sensor), InputError);
}

TEST_CASE("SSIM refuses images that cannot be compared") {
  const cv::Mat image(4, 5, CV_32FC3, cv::Scalar::all(0));
  CHECK_THROWS_AS(ssim(image, cv::Mat(5, 4, CV_32FC3)), InputError);
  CHECK_THROWS_AS(ssim(cv::Mat(), cv::Mat()), InputError);
  cv::Mat broken = image.clone();
  broken.at<cv::Vec3f>(0, 0)[0] = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_AS(ssim(broken, image), InputError);
}
