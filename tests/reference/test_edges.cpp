#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/reference/scenes.h"
#include "tests/reference/splatting.h"

using namespace surefield;
using namespace surefield::reference;

namespace {

/// One pixel, with the optical axis through it.
Camera one_pixel() {
  Camera camera;
  camera.intrinsics = {1, 1, 100, 100, 0, 0};
  return camera;
}

void add(Gaussians& gaussians, double z, double opacity, double x = 0) {
  gaussians.means.emplace_back(x, 0, z);
  gaussians.log_scales.push_back(Eigen::Vector3d::Constant(std::log(z / 100)));
  gaussians.rotations.emplace_back(1, 0, 0, 0);
  gaussians.opacity_logits.push_back(std::log(opacity / (1 - opacity)));
  gaussians.sh.insert(gaussians.sh.end(), 3, 0.0);
}

/// The edge flags of a pixel that sees Gaussians of these depths and opacities.
struct Flags {
  bool blend, median, dominator, any;

  explicit Flags(const std::vector<std::pair<double, double>>& depths_and_opacities) {
    Gaussians gaussians;
    for (const auto& [z, opacity] : depths_and_opacities) add(gaussians, z, opacity);
    const Images images = render(gaussians, one_pixel(), {});
    blend = images.blend_edge[0];
    median = images.median_edge[0];
    dominator = images.dominator_edge[0];
    any = images.on_edge[0];
  }
};

}  // namespace

TEST_CASE("a pixel without close decisions is on no edge") {
  const Flags flags({{1, 0.3}, {2, 0.9}, {3, 0.5}});
  CHECK_FALSE(flags.blend);
  CHECK_FALSE(flags.median);
  CHECK_FALSE(flags.dominator);
  CHECK_FALSE(flags.any);
}

TEST_CASE("alphas next to a limit put the pixel on an edge, on either side") {
  for (const double limit : {1.0 / 255, 0.99}) {
    for (const double factor : {0.99995, 1.00005}) CHECK(Flags({{1, limit * factor}}).blend);
    for (const double factor : {0.9995, 1.0005}) CHECK_FALSE(Flags({{1, limit * factor}}).any);
  }
}

TEST_CASE("a stop in doubt is an edge") {
  // T: 0.02, 4e-4, then 1e-4 or so. Alphas of 0.98 amplify the errors of T by 100.
  CHECK(Flags({{1, 0.98}, {2, 0.98}, {3, 0.75 * 1.0001}}).blend);
  CHECK(Flags({{1, 0.98}, {2, 0.98}, {3, 0.75 * 0.9999}}).blend);
  CHECK_FALSE(Flags({{1, 0.98}, {2, 0.98}, {3, 0.74}}).any);
  CHECK_FALSE(Flags({{1, 0.98}, {2, 0.98}, {3, 0.76}}).any);
  // Two saturated Gaussians leave T at 0.01^2, which rounding puts on either side of 1e-4.
  CHECK(Flags({{1, 0.9999}, {2, 0.9999}}).blend);
}

TEST_CASE("a median in doubt is an edge of the median alone") {
  for (const double opacity : {0.49999, 0.50001}) {
    const Flags flags({{1, opacity}, {2, 0.9}});
    CHECK(flags.median);
    CHECK(flags.any);
    CHECK_FALSE(flags.blend);
  }
  CHECK_FALSE(Flags({{1, 0.49}, {2, 0.9}}).any);
}

TEST_CASE("equal largest weights are an edge of the dominator alone, unless a larger one follows") {
  const Flags flags({{1, 0.4}, {2, 0.4 / 0.6}});
  CHECK(flags.dominator);
  CHECK(flags.any);
  CHECK_FALSE(flags.blend);
  CHECK_FALSE(flags.median);
  CHECK_FALSE(Flags({{1, 0.2}, {2, 0.25}, {3, 0.9}}).any);
  CHECK_FALSE(Flags({{1, 0.6}, {2, 0.25}, {3, 1.0 / 3}}).any);
}

TEST_CASE("nearly equal depths are an edge, copies of one Gaussian are not") {
  CHECK(Flags({{1, 0.3}, {1.000001, 0.6}}).blend);
  CHECK_FALSE(Flags({{1, 0.3}, {1.0001, 0.6}}).any);
  CHECK_FALSE(Flags({{1, 0.3}, {1, 0.6}}).any);
  CHECK_FALSE(Flags({{1, 0.3}, {1.000001, 0.003}}).any);  // the second is skipped
}

TEST_CASE("a Gaussian next to the near plane is an edge where it is seen, on either side of the plane") {
  CHECK(Flags({{0.01 * (1 + 5e-6), 0.3}}).blend);
  CHECK(Flags({{0.01 * (1 - 5e-6), 0.3}}).blend);
  CHECK_FALSE(Flags({{0.01 * (1 + 5e-5), 0.3}}).any);
  CHECK_FALSE(Flags({{0.01 * (1 - 5e-6), 0.001}}).any);
}

TEST_CASE("clamps next to their limits mark the Gaussian") {
  const double limit = 1.3 * 0.5 / 100;  // of x/z; depth 2
  Gaussians gaussians;
  add(gaussians, 2, 0.5, 2 * limit * 1.00005);
  add(gaussians, 2, 0.5, -2 * limit * 0.99995);
  add(gaussians, 2, 0.5, 2 * limit * 1.001);
  add(gaussians, 2, 0.5);
  gaussians.sh[9] = -0.5 / 0.28209479177387814 + 1e-5;
  const Images images = render(gaussians, one_pixel(), {});
  CHECK(images.gaussian_edge == std::vector<uint8_t>{1, 1, 0, 1});
}

TEST_CASE("few pixels of a random scene are on an edge") {
  const Scene scene = random_scene(1, 100, {.kind = SceneKind::anisotropic});
  const Images images = render(Gaussians(scene.cloud), scene.camera, scene.depth);
  const auto edges = std::count(images.on_edge.begin(), images.on_edge.end(), 1);
  CHECK(edges < static_cast<long>(images.on_edge.size()) / 20);
}
