#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "tests/reference/splatting.h"

using namespace surefield;
using namespace surefield::reference;

namespace {

constexpr double sh_constant = 0.28209479177387814;
constexpr int centre = 5 * 11 + 5;  // the pixel at the principal point

/// 11 x 11 pixels, looking along z from the origin, principal point on the middle pixel.
Camera axis_camera() {
  Camera camera;
  camera.intrinsics = {11, 11, 100, 100, 5, 5};
  return camera;
}

/// Adds an isotropic Gaussian on the optical axis whose image has a standard deviation of 1 pixel before the
/// blur.
void add(Gaussians& gaussians, double z, double opacity, const Eigen::Vector3d& colour) {
  gaussians.means.emplace_back(0, 0, z);
  gaussians.log_scales.push_back(Eigen::Vector3d::Constant(std::log(z / 100)));
  gaussians.rotations.emplace_back(1, 0, 0, 0);
  gaussians.opacity_logits.push_back(std::log(opacity / (1 - opacity)));
  for (int channel = 0; channel < 3; ++channel) gaussians.sh.push_back((colour[channel] - 0.5) / sh_constant);
}

}  // namespace

TEST_CASE("one Gaussian on the axis") {
  Gaussians gaussians;
  add(gaussians, 2, 0.8, {0.2, 0.4, 0.9});
  Settings settings;
  settings.background = {1, 0.5, 0};
  const std::vector<float> sensor(121, 1.5f);
  const Images images = render(gaussians, axis_camera(), sensor, settings);

  CHECK(images.colour[centre * 3] == doctest::Approx(0.8 * 0.2 + 0.2 * 1).epsilon(1e-12));
  CHECK(images.colour[centre * 3 + 1] == doctest::Approx(0.8 * 0.4 + 0.2 * 0.5).epsilon(1e-12));
  CHECK(images.colour[centre * 3 + 2] == doctest::Approx(0.8 * 0.9).epsilon(1e-12));
  CHECK(images.opacity[centre] == doctest::Approx(0.8).epsilon(1e-12));
  CHECK(images.depth[centre] == doctest::Approx(1.6).epsilon(1e-12));
  CHECK(images.depth_normalised[centre] == doctest::Approx(2).epsilon(1e-12));
  CHECK(images.depth_median[centre] == doctest::Approx(2).epsilon(1e-12));
  CHECK(images.uncertainty[centre] == doctest::Approx(0.8 * 0.25).epsilon(1e-12));
  CHECK(images.dominator[centre] == 0);
  CHECK(images.dominator_weight[centre] == doctest::Approx(0.8).epsilon(1e-12));

  // Two pixels to the right of it: variance 1 + 0.3, and T stays above 0.5.
  const double alpha = 0.8 * std::exp(-0.5 * 4 / 1.3);
  CHECK(images.opacity[centre + 2] == doctest::Approx(alpha).epsilon(1e-12));
  CHECK(images.depth_normalised[centre + 2] == doctest::Approx(2).epsilon(1e-12));
  CHECK(images.depth_median[centre + 2] == 0);

  // In the corner, d^2 = 50, alpha is below 1/255: the background shows.
  CHECK(images.opacity[0] == 0);
  CHECK(images.depth_normalised[0] == 0);
  CHECK(images.dominator[0] == -1);
  CHECK(images.dominator_weight[0] == 0);
  CHECK(images.colour[0] == 1);
}

TEST_CASE("two stacked Gaussians, the farther one first in memory") {
  Gaussians gaussians;
  add(gaussians, 2, 0.8, {1, 0, 0});
  add(gaussians, 1, 0.4, {0, 1, 0.5});
  const std::vector<float> sensor(121, 1.5f);
  const Images images = render(gaussians, axis_camera(), sensor);

  // Weights: 0.4 near, 0.6 * 0.8 = 0.48 far; T: 1, 0.6, 0.12.
  CHECK(images.colour[centre * 3] == doctest::Approx(0.48).epsilon(1e-12));
  CHECK(images.colour[centre * 3 + 1] == doctest::Approx(0.4).epsilon(1e-12));
  CHECK(images.colour[centre * 3 + 2] == doctest::Approx(0.2).epsilon(1e-12));
  CHECK(images.opacity[centre] == doctest::Approx(0.88).epsilon(1e-12));
  CHECK(images.depth[centre] == doctest::Approx(0.4 + 0.96).epsilon(1e-12));
  CHECK(images.depth_normalised[centre] == doctest::Approx(1.36 / 0.88).epsilon(1e-12));
  CHECK(images.depth_median[centre] == doctest::Approx(2).epsilon(1e-12));
  CHECK(images.uncertainty[centre] == doctest::Approx(0.88 * 0.25).epsilon(1e-12));
  CHECK(images.dominator[centre] == 0);
  CHECK(images.dominator_weight[centre] == doctest::Approx(0.48).epsilon(1e-12));
}

TEST_CASE("of Gaussians at one depth the lower index is in front") {
  Gaussians gaussians;
  add(gaussians, 1, 0.6, {1, 0, 0});
  add(gaussians, 1, 0.6, {0, 1, 0});
  const Images images = render(gaussians, axis_camera(), {});
  CHECK(images.colour[centre * 3] == doctest::Approx(0.6).epsilon(1e-12));
  CHECK(images.colour[centre * 3 + 1] == doctest::Approx(0.24).epsilon(1e-12));
  CHECK(images.dominator[centre] == 0);
}

TEST_CASE("alpha is clamped at 0.99, and blending stops before T falls below 1e-4") {
  Gaussians gaussians;
  add(gaussians, 1, 0.9999, {1, 0, 0});
  add(gaussians, 2, 0.98, {0, 1, 0});
  add(gaussians, 3, 0.9, {0, 0, 1});  // would take T from 2e-4 to 2e-5
  add(gaussians, 4, 0.3, {0, 0, 1});  // would leave T at 1.4e-4, but comes after the stop
  Decisions decisions;
  const Images images = render(gaussians, axis_camera(), {}, {}, &decisions);
  CHECK(images.colour[centre * 3] == doctest::Approx(0.99).epsilon(1e-12));
  CHECK(images.colour[centre * 3 + 1] == doctest::Approx(0.0098).epsilon(1e-12));
  CHECK(images.colour[centre * 3 + 2] == 0);
  CHECK(images.opacity[centre] == doctest::Approx(1 - 2e-4).epsilon(1e-12));
  REQUIRE(decisions.pixels[centre].contributions.size() == 2);
  CHECK(decisions.pixels[centre].contributions[0].saturated);
  CHECK_FALSE(decisions.pixels[centre].contributions[1].saturated);
}

TEST_CASE("alphas below 1/255 are skipped, those just above are not") {
  Gaussians gaussians;
  add(gaussians, 1, 0.0039, {1, 1, 1});
  CHECK(render(gaussians, axis_camera(), {}).opacity[centre] == 0);
  gaussians = {};
  add(gaussians, 1, 0.00393, {1, 1, 1});
  CHECK(render(gaussians, axis_camera(), {}).opacity[centre] == doctest::Approx(0.00393).epsilon(1e-12));
}

TEST_CASE("Gaussians nearer than the near plane or behind the camera take no part") {
  Gaussians gaussians;
  add(gaussians, 0.009, 0.9, {1, 1, 1});
  add(gaussians, 1, 0.5, {1, 1, 1});
  gaussians.means.push_back({0, 0, -1});
  gaussians.log_scales.push_back(Eigen::Vector3d::Zero());
  gaussians.rotations.emplace_back(1, 0, 0, 0);
  gaussians.opacity_logits.push_back(3);
  gaussians.sh.insert(gaussians.sh.end(), 3, 0.0);
  CHECK(render(gaussians, axis_camera(), {}).opacity[centre] == doctest::Approx(0.5).epsilon(1e-12));
}

TEST_CASE("negative colours are clamped at 0") {
  Gaussians gaussians;
  add(gaussians, 1, 0.5, {-0.3, 0.3, 2});
  const Images images = render(gaussians, axis_camera(), {});
  CHECK(images.colour[centre * 3] == 0);
  CHECK(images.colour[centre * 3 + 1] == doctest::Approx(0.15).epsilon(1e-12));
  CHECK(images.colour[centre * 3 + 2] == doctest::Approx(1).epsilon(1e-12));
}

TEST_CASE("the uncertainty is 0 where the sensor depth is invalid") {
  Gaussians gaussians;
  add(gaussians, 2, 0.8, {1, 1, 1});
  for (const float invalid :
       {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    const std::vector<float> sensor(121, invalid);
    CHECK(render(gaussians, axis_camera(), sensor).uncertainty[centre] == 0);
  }
  CHECK(render(gaussians, axis_camera(), {}).uncertainty[centre] == 0);
}

TEST_CASE("a gradient by hand: the opacity of one Gaussian") {
  Gaussians gaussians;
  add(gaussians, 2, 0.8, {0.2, 0.4, 0.9});
  Settings settings;
  settings.background = {1, 0, 0};
  ImageGradients upstream(11, 11);
  upstream.colour[centre * 3] = 1;
  const Gradients gradients = backward(gaussians, axis_camera(), {}, upstream, settings);
  CHECK(gradients.projections[0].opacity == doctest::Approx(0.2 - 1).epsilon(1e-12));
  CHECK(gradients.opacity_logits[0] == doctest::Approx((0.2 - 1) * 0.8 * 0.2).epsilon(1e-12));
  CHECK(gradients.projections[0].colour.x() == doctest::Approx(0.8).epsilon(1e-12));
  CHECK(gradients.sh[0] == doctest::Approx(0.8 * sh_constant).epsilon(1e-12));
}
