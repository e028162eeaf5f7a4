#include <doctest/doctest.h>

#include "engine/slam/exposure.h"

using namespace surefield;

namespace {

constexpr int kWidth = 20, kHeight = 15, kPixels = kWidth * kHeight;

/// A frame of many colours, 2 m away, and what a map of `gains` times its exposure renders to.
struct ExposedPair {
  Frame frame;
  RenderImages rendered{.width = kWidth, .height = kHeight};

  explicit ExposedPair(const Eigen::Vector3f& gains) {
    frame.colour = cv::Mat(kHeight, kWidth, CV_8UC3);
    frame.depth = cv::Mat(kHeight, kWidth, CV_32FC1, cv::Scalar(2));
    rendered.opacity.assign(kPixels, 1.0f);
    rendered.depth_normalised.assign(kPixels, 2.0f);
    for (int i = 0; i < 3 * kPixels; ++i) {
      const auto value = static_cast<uint8_t>(20 + i * 7 % 200);
      frame.colour.data[i] = value;
      rendered.colour.push_back(gains[i % 3] * static_cast<float>(value) / 255);
    }
  }
};

}  // namespace

TEST_CASE("the gains of a frame are those between the render and its colours") {
  const Eigen::Vector3f gains(1.5f, 1.25f, 0.5f);
  const ExposedPair pair(gains);
  const auto found = fit_gains(pair.frame, pair.rendered);
  REQUIRE(found);
  CHECK(found->isApprox(gains, 1e-4f));
}

TEST_CASE(
    "what the map does not show, another surface, and saturated pixels say nothing about the exposure") {
  const Eigen::Vector3f gains(1.5f, 1.25f, 0.5f);
  ExposedPair pair(gains);
  for (int i = 0; i < kPixels / 3; ++i) {
    for (int c = 0; c < 3; ++c) pair.rendered.colour[3 * i + c] = 0.9f;
    switch (i % 5) {
      case 0:
        pair.rendered.opacity[i] = 0.5f;
        break;
      case 1:
        pair.rendered.depth_normalised[i] = 2.2f;
        break;
      case 2:
        pair.frame.depth.ptr<float>()[i] = 0;
        break;
      case 3:
        pair.frame.depth.ptr<float>()[i] = 6;
        break;
      default:
        pair.frame.colour.at<cv::Vec3b>(i / kWidth, i % kWidth) = cv::Vec3b(255, 255, 255);
    }
  }
  const auto found = fit_gains(pair.frame, pair.rendered);
  REQUIRE(found);
  CHECK(found->isApprox(gains, 1e-4f));
}

TEST_CASE("a fifth of the pixels that look different moves the gains by little") {
  const Eigen::Vector3f gains(0.8f, 0.9f, 1.1f);
  ExposedPair pair(gains);
  for (int i = 0; i < 3 * kPixels; ++i)
    if (i / 3 % 5 == 0) pair.rendered.colour[i] = 1;
  const auto found = fit_gains(pair.frame, pair.rendered);
  REQUIRE(found);
  CHECK((*found - gains).cwiseAbs().maxCoeff() < 0.03f);
}

TEST_CASE("there are no gains where the map shows too little of the frame, or black") {
  ExposedPair pair(Eigen::Vector3f::Ones());
  pair.rendered.opacity.assign(kPixels, 0.0f);
  CHECK_FALSE(fit_gains(pair.frame, pair.rendered));
  pair.rendered.opacity.assign(kPixels, 1.0f);
  CHECK(fit_gains(pair.frame, pair.rendered));
  pair.rendered.colour.assign(3 * kPixels, 0.0f);
  CHECK_FALSE(fit_gains(pair.frame, pair.rendered));
  CHECK_FALSE(fit_gains(Frame{}, RenderImages{}));
}
