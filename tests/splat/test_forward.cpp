#include <doctest/doctest.h>

#include "engine/gpu/recorder.h"
#include "engine/splat/rasteriser.h"
#include "tests/reference/scenes.h"
#include "tests/reference/splatting.h"
#include "tests/splat/compare.h"
#include "tests/support/device.h"

using namespace surefield;
using reference::SceneKind;
using testing::largest_difference;

namespace {

/// Compares every output with the oracle's at the pixels that lie on no edge.
void compare_with_oracle(const reference::Scene& scene, const TileShape& shape,
                         const Eigen::Vector3d& background, DepthModel model = DepthModel::Plane) {
  gpu::Device& device = testing::device();
  Rasteriser rasteriser(device, shape);
  GaussianMap map(device);
  map.assign(scene.cloud, model);
  const RenderImages got = rasteriser.render(map, scene.camera, scene.depth, background.cast<float>());
  reference::Settings settings;
  settings.background = background;
  settings.plane_depth = model == DepthModel::Plane;
  const reference::Images want =
      reference::render(reference::Gaussians(scene.cloud), scene.camera, scene.depth, settings);

  std::size_t compared = 0;
  for (std::size_t i = 0; i < want.opacity.size(); ++i) {
    if (want.blend_edge[i]) continue;
    ++compared;
    for (std::size_t k = 0; k < 3; ++k)
      CHECK(got.colour[3 * i + k] == doctest::Approx(want.colour[3 * i + k]).epsilon(3e-4));
    CHECK(std::abs(got.opacity[i] - want.opacity[i]) < 1e-4);
    CHECK(std::abs(got.depth[i] - want.depth[i]) < 3e-4);
    CHECK(got.depth_normalised[i] == doctest::Approx(want.depth_normalised[i]).epsilon(3e-4));
    CHECK(got.uncertainty[i] == doctest::Approx(want.uncertainty[i]).epsilon(1e-3));
    if (!want.median_edge[i])
      CHECK(got.depth_median[i] == doctest::Approx(want.depth_median[i]).epsilon(1e-5));
    if (!want.dominator_edge[i]) CHECK(got.dominator[i] == want.dominator[i]);
    CHECK(std::abs(got.dominator_weight[i] - want.dominator_weight[i]) < 1e-4);
  }
  // Edges are rare; a scene of which little is compared would prove little.
  CHECK(compared * 10 > want.opacity.size() * 5);
}

TileShape shape_of(uint32_t side) {
  return {.width = side, .height = side, .lanes = testing::device().limits().subgroup_size};
}

}  // namespace

TEST_CASE("every output agrees with the oracle on every kind of scene") {
  uint32_t seed = 1;
  for (SceneKind kind : reference::all_scene_kinds) {
    for (int degree : {0, 3}) {
      CAPTURE(static_cast<int>(kind));
      CAPTURE(degree);
      const auto scene = reference::random_scene(++seed, 150, {.kind = kind, .sh_degree = degree});
      compare_with_oracle(scene, TileShape::for_device(testing::device()), Eigen::Vector3d::Zero());
    }
  }
}

TEST_CASE("single Gaussians, odd and tiny images, SH degrees 1 and 2") {
  for (const auto& size : {std::pair{1, 1}, {1, 37}, {53, 1}, {7, 9}, {65, 41}}) {
    const int width = size.first, height = size.second;
    CAPTURE(width);
    CAPTURE(height);
    for (int count : {1, 40})
      compare_with_oracle(
          reference::random_scene(11, count, {.sh_degree = 1, .width = width, .height = height}),
          TileShape::for_device(testing::device()), Eigen::Vector3d(0.2, 0.5, 0.9));
  }
  compare_with_oracle(reference::random_scene(12, 60, {.sh_degree = 2}),
                      TileShape::for_device(testing::device()), Eigen::Vector3d(0.2, 0.5, 0.9));
}

TEST_CASE("other tile shapes give the same images") {
  const auto scene = reference::random_scene(21, 300, {.kind = SceneKind::mixed});
  compare_with_oracle(scene, shape_of(16), Eigen::Vector3d::Zero());
}

TEST_CASE("the depth of a Gaussian's centre, as in the paper, instead of its plane's") {
  compare_with_oracle(reference::random_scene(15, 90, {.kind = SceneKind::anisotropic}), shape_of(8),
                      {0, 0, 0}, DepthModel::Centre);
}

TEST_CASE("thousands of Gaussians") {
  const auto scene =
      reference::random_scene(31, 4000, {.kind = SceneKind::isotropic_small, .width = 96, .height = 72});
  compare_with_oracle(scene, TileShape::for_device(testing::device()), Eigen::Vector3d::Zero());
}

TEST_CASE("an empty map renders the background") {
  gpu::Device& device = testing::device();
  Rasteriser rasteriser(device);
  GaussianMap map(device);
  Camera camera{{.width = 20, .height = 10, .fx = 20, .fy = 20, .cx = 9.5, .cy = 4.5}};
  const RenderImages images = rasteriser.render(map, camera, {}, {0.25f, 0.5f, 0.75f});
  for (std::size_t i = 0; i < 200; ++i) {
    CHECK(images.colour[3 * i + 2] == 0.75f);
    CHECK(images.opacity[i] == 0);
    CHECK(images.dominator[i] == -1);
    CHECK(images.depth_normalised[i] == 0);
  }
}

TEST_CASE("more instances than room: the lists grow and the image is complete") {
  gpu::Device& device = testing::device();
  const auto scene =
      reference::random_scene(41, 3000, {.kind = SceneKind::larger_than_image, .width = 400, .height = 300});
  Rasteriser rasteriser(device);
  const uint32_t before = rasteriser.lists.instance_capacity();
  GaussianMap map(device);
  map.assign(scene.cloud);
  const RenderImages first = rasteriser.render(map, scene.camera);
  CHECK(rasteriser.lists.instance_capacity() > before);
  const RenderImages second = rasteriser.render(map, scene.camera);
  CHECK(first.colour == second.colour);
  CHECK(*std::max_element(first.opacity.begin(), first.opacity.end()) > 0.5f);
}
