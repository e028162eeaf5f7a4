#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/reference/projection.h"
#include "tests/reference/scenes.h"

using namespace surefield;
using namespace surefield::reference;

namespace {

std::vector<Projection> project_scene(const Scene& scene) {
  const Gaussians gaussians(scene.cloud);
  std::vector<Projection> projections;
  for (std::size_t i = 0; i < gaussians.size(); ++i) {
    projections.push_back(project(gaussians, static_cast<int>(i), scene.camera, {}));
  }
  return projections;
}

/// The share of a scene's Gaussians for which `holds` is true.
template <class Predicate>
double share(SceneKind kind, const Predicate& holds) {
  const auto projections = project_scene(random_scene(1, 200, {.kind = kind}));
  return static_cast<double>(std::count_if(projections.begin(), projections.end(), holds)) / 200;
}

double standard_deviation(const Projection& p) {
  return std::sqrt(p.covariance.trace() / 2);
}

}  // namespace

TEST_CASE("a random scene depends on its arguments alone, and its arrays agree") {
  for (const SceneKind kind : all_scene_kinds) {
    const SceneOptions options{.kind = kind, .sh_degree = 2, .width = 20, .height = 10};
    const Scene a = random_scene(4, 30, options), b = random_scene(4, 30, options),
                c = random_scene(5, 30, options);
    CHECK(a.cloud.means == b.cloud.means);
    CHECK(a.cloud.sh == b.cloud.sh);
    CHECK(a.cloud.means != c.cloud.means);
    CHECK(a.cloud.size() == 30);
    CHECK(a.cloud.log_scales.size() == 30);
    CHECK(a.cloud.rotations.size() == 30);
    CHECK(a.cloud.opacity_logits.size() == 30);
    CHECK(a.cloud.sh.size() == 30 * 9 * 3);
    CHECK(a.depth.size() == 200);
    CHECK(a.colour.size() == 600);
  }
}

TEST_CASE("each kind of scene is what its name says") {
  CHECK(share(SceneKind::isotropic_small, [](const Projection& p) { return standard_deviation(p) < 2; }) >
        0.9);
  CHECK(share(SceneKind::behind_camera, [](const Projection& p) { return p.decisions.culled; }) > 0.3);
  CHECK(share(SceneKind::at_border, [](const Projection& p) {
          return p.decisions.tangent_clamp != std::array<int, 2>{0, 0};
        }) > 0.1);
  CHECK(share(SceneKind::larger_than_image, [](const Projection& p) { return standard_deviation(p) > 20; }) >
        0.8);
  CHECK(share(SceneKind::low_opacity, [](const Projection& p) { return p.opacity < 1.0 / 255; }) > 0.1);
  CHECK(share(SceneKind::low_opacity, [](const Projection& p) { return p.opacity > 1.0 / 255; }) > 0.5);
  CHECK(share(SceneKind::high_opacity, [](const Projection& p) { return p.opacity > 0.99; }) > 0.2);
  CHECK(share(SceneKind::anisotropic, [](const Projection& p) {
          return p.covariance.trace() * p.covariance.trace() > 20 * p.covariance.determinant();
        }) > 0.1);
}
