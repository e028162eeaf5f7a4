#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "tests/reference/finite_differences.h"
#include "tests/reference/losses.h"
#include "tests/reference/scenes.h"
#include "tests/reference/splatting.h"

using namespace surefield;
using namespace surefield::reference;

namespace {

/// A rendered random scene, its observation, and flags of visible Gaussians.
struct Example {
  Scene scene = random_scene(6, 40, {.kind = SceneKind::anisotropic, .width = 16, .height = 12});
  Gaussians gaussians{scene.cloud};
  Images images = render(gaussians, scene.camera, scene.depth);
  Observation observed{scene.colour, scene.depth};
  std::vector<uint8_t> visible;

  Example() {
    for (std::size_t i = 0; i < gaussians.size(); ++i) visible.push_back(i % 3 != 0);
  }
};

/// Pairs of an image and its claimed gradient.
std::vector<std::pair<std::vector<double>*, const std::vector<double>*>> pairs(Images& images,
                                                                               const ImageGradients& g) {
  return {{&images.colour, &g.colour},
          {&images.opacity, &g.opacity},
          {&images.depth, &g.depth},
          {&images.depth_normalised, &g.depth_normalised},
          {&images.depth_median, &g.depth_median},
          {&images.uncertainty, &g.uncertainty}};
}

void check_close(double value, double expected) {
  CHECK(std::abs(value - expected) < 1e-9 + 1e-7 * std::abs(expected));
}

/// Checks `gradients` of the loss `f`, which reads `images`. A missing median is no number that could vary.
template <class Function>
void check_images(const Function& f, Images& images, const ImageGradients& gradients) {
  for (const auto& [image, gradient] : pairs(images, gradients)) {
    REQUIRE(image->size() == gradient->size());
    for (std::size_t i = 0; i < image->size(); ++i) {
      if (image == &images.depth_median && (*image)[i] == 0) {
        CHECK((*gradient)[i] == 0);
      } else {
        check_close((*gradient)[i], central_difference(f, (*image)[i], 1e-6));
      }
    }
  }
}

/// A 2 x 1 rendering: opaque pixels of grey 0.5 and 0.25, depths 2 and 3, medians 2.5 and none, U of 0.1 and
/// 0.3.
Images two_pixels() {
  Images images(2, 1);
  images.colour = {0.5, 0.5, 0.5, 0.25, 0.25, 0.25};
  images.opacity = {1, 1};
  images.depth = images.depth_normalised = {2, 3};
  images.depth_median = {2.5, 0};
  images.uncertainty = {0.1, 0.3};
  return images;
}

}  // namespace

TEST_CASE("the terms of the mapping loss by hand; the pixel without depth takes no part") {
  Gaussians gaussians;
  gaussians.means.resize(3);
  gaussians.log_scales = {{0, std::log(2), std::log(4)}, {0, 0, 0}, {0, 0, std::log(9)}};
  const std::vector<float> colour{0.5f, 0.75f, 0.5f, 0, 0, 0};
  const std::vector<uint8_t> visible{1, 1, 0};
  const std::vector<float> depth{1.5f, std::numeric_limits<float>::quiet_NaN()};
  const MappingLossSettings settings;
  const MappingLoss loss = mapping_loss(two_pixels(), {colour, depth}, gaussians, visible, settings);
  CHECK(loss.colour == doctest::Approx(0.25 / 3).epsilon(1e-12));
  CHECK(loss.depth == doctest::Approx(0.5).epsilon(1e-12));
  CHECK(loss.align == doctest::Approx(0.5).epsilon(1e-12));
  CHECK(loss.isotropy == doctest::Approx((4 - 1) / 2.0).epsilon(1e-12));
  CHECK(loss.variance == doctest::Approx(0.1).epsilon(1e-12));
  CHECK(loss.total == doctest::Approx(0.7 * loss.colour + 0.1 * loss.ssim + 0.25 * 0.5 + 0.25 * 0.5 +
                                      0.1 * 1.5 + 0.15 * 0.1)
                          .epsilon(1e-12));
  CHECK(loss.images.depth == std::vector<double>{0.25 - 0.25, 0});
  CHECK(loss.images.depth_median == std::vector<double>{0.25, 0});
  CHECK(loss.images.uncertainty == std::vector<double>{0.15, 0});
  CHECK(loss.log_scales[0].isApprox(Eigen::Vector3d(-0.2, 0, 0.2)));
  CHECK(loss.log_scales[1].isZero(0));
  CHECK(loss.log_scales[2].isZero(0));
}

TEST_CASE("the mapping loss of nothing is finite") {
  Images images(2, 1);
  const std::vector<float> colour(6, 0.0f), depth(2, 0.0f);
  const MappingLoss loss = mapping_loss(images, {colour, depth}, {}, {});
  CHECK(loss.total == doctest::Approx(0));
}

TEST_CASE("the mapping loss's gradients agree with finite differences, alone and together") {
  Example example;
  for (int term = 0; term <= 6; ++term) {
    for (const DepthKind kind : {DepthKind::alpha, DepthKind::normalised}) {
      CAPTURE(term);
      MappingLossSettings settings;
      settings.depth_kind = kind;
      double* weights[] = {&settings.colour, &settings.ssim,     &settings.depth,
                           &settings.align,  &settings.isotropy, &settings.variance};
      for (int i = 0; i < 6 && term < 6; ++i) *weights[i] = i == term ? 1 : 0;
      if (term != 6 && kind == DepthKind::normalised && term != 2 && term != 3) continue;
      const auto f = [&] {
        return mapping_loss(example.images, example.observed, example.gaussians, example.visible, settings)
            .total;
      };
      const MappingLoss loss =
          mapping_loss(example.images, example.observed, example.gaussians, example.visible, settings);
      check_images(f, example.images, loss.images);
      for (std::size_t i = 0; i < example.gaussians.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
          check_close(loss.log_scales[i][axis],
                      central_difference(f, example.gaussians.log_scales[i][axis], 1e-4));
        }
      }
    }
  }
}

TEST_CASE("the tracking loss by hand: opacity, validity and outliers") {
  // Depth residuals 0.1 (x 3), 1.5; the last pixel is not opaque, the one before has no sensor depth.
  Images images(6, 1);
  images.opacity = {1, 1, 1, 1, 1, 0.99};
  images.depth = {2.1, 1.9, 2.1, 3.5, 9, 9};
  images.depth_normalised = images.depth;
  images.colour.assign(18, 0.5);
  for (int channel = 0; channel < 3; ++channel) images.colour[4 * 3 + channel] = 0.5 + 0.01 * 10;
  const std::vector<float> depth{2, 2, 2, 2, 0, 2};
  std::vector<float> colour(18, 0.5f);
  for (int pixel = 0; pixel < 4; ++pixel) colour[pixel * 3] = 0.47f;  // residual 0.01
  colour[15] = 0;
  const TrackingLoss loss = tracking_loss(images, {colour, depth});
  CHECK(loss.depth_median == doctest::Approx(0.1).epsilon(1e-9));
  CHECK(loss.depth_mask == std::vector<uint8_t>{1, 1, 1, 0, 0, 0});
  CHECK(loss.depth == doctest::Approx(0.1).epsilon(1e-9));
  CHECK(loss.colour_median == doctest::Approx(0.01).epsilon(1e-6));
  CHECK(loss.colour_mask[0] == 1);
  CHECK(loss.colour_mask[5] == 0);
  CHECK(loss.total == doctest::Approx(0.2 * loss.colour + loss.depth).epsilon(1e-12));
  for (const std::size_t pixel : {3, 4, 5}) CHECK(loss.images.depth[pixel] == 0);
  CHECK(loss.images.depth[0] == doctest::Approx(1.0 / 3));
  CHECK(loss.images.depth[1] == doctest::Approx(-1.0 / 3));
}

TEST_CASE("colour outliers beyond ten times the median are masked, those within are not") {
  for (const double residual : {0.09, 0.11}) {
    Images images(3, 1);
    images.opacity = {1, 1, 1};
    images.colour = {0.01, 0.01, 0.01, 0.01, 0.01, 0.01, residual, residual, residual};
    const std::vector<float> colour(9, 0.0f), depth(3, 0.0f);
    const TrackingLoss loss = tracking_loss(images, {colour, depth});
    const bool inlier = residual < 0.1;
    CHECK(loss.colour_mask == std::vector<uint8_t>{1, 1, inlier});
    CHECK(loss.colour == doctest::Approx(inlier ? 0.11 / 3 : 0.01).epsilon(1e-12));
    CHECK(loss.images.colour[0] == doctest::Approx(0.2 / (inlier ? 9 : 6)).epsilon(1e-12));
  }
}

TEST_CASE("the median of an even number of residuals is the lower one") {
  Images images(2, 1);
  images.opacity = {1, 1};
  images.depth = {1.25, 2};
  const std::vector<float> colour(6, 0.0f), depth(2, 1.0f);
  CHECK(tracking_loss(images, {colour, depth}).depth_median == doctest::Approx(0.25));
}

TEST_CASE("the tracking loss's gradients agree with finite differences") {
  Example example;
  TrackingLossSettings settings;
  settings.minimum_opacity = 0.3;
  settings.outlier_factor = 1.5;
  for (const DepthKind kind : {DepthKind::alpha, DepthKind::normalised}) {
    settings.depth_kind = kind;
    const TrackingLoss loss = tracking_loss(example.images, example.observed, settings);
    const auto dropped = std::count(loss.colour_mask.begin(), loss.colour_mask.end(), 0);
    CHECK(dropped > 20);
    CHECK(dropped < 172);
    const auto f = [&] { return tracking_loss(example.images, example.observed, settings).total; };
    check_images(f, example.images, loss.images);
  }
}

TEST_CASE("sizes that do not agree are refused") {
  const std::vector<float> colour(3, 0.0f), depth(2, 1.0f);
  CHECK_THROWS_AS(tracking_loss(two_pixels(), {colour, depth}), std::invalid_argument);
  CHECK_THROWS_AS(render({}, random_scene(1, 1).camera, depth), std::invalid_argument);
}
