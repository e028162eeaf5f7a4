#include <doctest/doctest.h>

#include <random>

#include "engine/gpu/recorder.h"
#include "engine/splat/rasteriser.h"
#include "tests/reference/scenes.h"
#include "tests/reference/splatting.h"
#include "tests/splat/compare.h"
#include "tests/splat/upstream.h"
#include "tests/support/device.h"

using namespace surefield;
using reference::SceneKind;
using testing::largest_difference;
using testing::magnitude;

namespace {

/// Which outputs the loss depends on.
enum class Upstream { Colour, Opacity, Depth, Normalised, Median, Uncertainty, All };

/// Random dL/d(image) of the chosen outputs, zero at pixels on an edge.
reference::ImageGradients random_upstream(const reference::Images& images, Upstream which, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  reference::ImageGradients g(images.width, images.height);
  const auto wants = [&](Upstream u) { return which == u || which == Upstream::All; };
  for (std::size_t i = 0; i < images.opacity.size(); ++i) {
    if (images.blend_edge[i]) continue;
    if (wants(Upstream::Colour))
      for (std::size_t k = 0; k < 3; ++k) g.colour[3 * i + k] = uniform(random);
    if (wants(Upstream::Opacity)) g.opacity[i] = uniform(random);
    if (wants(Upstream::Depth)) g.depth[i] = uniform(random);
    // D/O is steep where almost nothing was blended; float and double differ there by nature.
    if (wants(Upstream::Normalised) && images.opacity[i] > 0.05) g.depth_normalised[i] = uniform(random);
    if (wants(Upstream::Median) && !images.median_edge[i]) g.depth_median[i] = uniform(random);
    if (wants(Upstream::Uncertainty)) g.uncertainty[i] = uniform(random);
  }
  return g;
}

std::vector<double> flat(std::initializer_list<glsl::vec3> list) {
  std::vector<double> values;
  for (const auto& v : list)
    for (float x : {v.x, v.y, v.z}) values.push_back(x);
  return values;
}

/// Gradients of the device, per class, flattened; and the pose's, from the full and from the tracking path.
struct DeviceGradients {
  std::vector<double> means, log_scales, rotations, opacity_logits, sh, pose, tracking_pose;
  std::vector<float> sampling;  ///< as the backward pass leaves it
};

DeviceGradients run_device(const reference::Scene& scene, const reference::ImageGradients& upstream,
                           PoseGradientKind kind, const TileShape& shape,
                           DepthModel model = DepthModel::Plane) {
  gpu::Device& device = testing::device();
  Rasteriser rasteriser(device, shape);
  const Eigen::Vector3f background(0.1f, 0.2f, 0.3f);
  GaussianMap map(device);
  map.assign(scene.cloud, model);
  gpu::Array<glsl::CameraState> camera(device, "camera");
  const glsl::CameraState state = to_device(scene.camera);
  camera.upload(std::span(&state, 1));
  gpu::Array<float> depth(device, "sensor depth");
  std::vector<float> clean = scene.depth;
  for (float& d : clean)
    if (!std::isfinite(d) || d < 0) d = 0;
  depth.upload(clean);
  const View view{
      .size = {state.width, state.height}, .camera = camera, .sensor_depth = depth, .background = background};
  // Grows the lists too.
  const RenderImages images = rasteriser.render(map, scene.camera, clean, background);
  std::vector<glsl::PixelUpstream> pixels;
  for (std::size_t i = 0; i < images.opacity.size(); ++i) {
    pixels.push_back(testing::upstream_at(upstream, images, i, {0.1, 0.2, 0.3}));
    if (clean[i] == 0) pixels.back().uncertainty = 0;
  }

  // Gradients of invisible Gaussians are not written: start from zero.
  const std::size_t count = scene.cloud.size(), coefficients = sh_coefficients(scene.cloud.sh_degree);
  rasteriser.gaussian_gradients.upload(std::vector<glsl::GaussianGradient>(count));
  rasteriser.sh_gradients.upload(std::vector<glsl::vec3>(count * coefficients));
  gpu::Recorder recorder(device);
  rasteriser.record_forward(recorder, map, view, Outputs::All);
  recorder.submit();
  rasteriser.pixel_upstream.upload(pixels);
  rasteriser.record_backward(recorder, map, view, kind, {});
  recorder.submit();

  DeviceGradients g;
  for (const auto& v : rasteriser.gaussian_gradients.download(count)) {
    for (double x : flat({v.mean})) g.means.push_back(x);
    for (double x : flat({v.log_scale})) g.log_scales.push_back(x);
    for (float x : {v.rotation.x, v.rotation.y, v.rotation.z, v.rotation.w}) g.rotations.push_back(x);
    g.opacity_logits.push_back(v.opacity_logit);
  }
  for (const auto& v : rasteriser.sh_gradients.download(count * coefficients))
    for (double x : flat({v})) g.sh.push_back(x);
  auto pose = rasteriser.pose_gradient.download(1)[0];
  g.pose = flat({pose.rotation, pose.translation});
  g.sampling = map.sampling.download(count);
  map.sampling.upload(scene.cloud.sampling);  // that of the images above
  rasteriser.record_backward_pose(recorder, map, view, kind);
  recorder.submit();
  pose = rasteriser.pose_gradient.download(1)[0];
  g.tracking_pose = flat({pose.rotation, pose.translation});
  return g;
}

template <class V>
std::vector<double> flat_eigen(const std::vector<V>& list) {
  std::vector<double> values;
  for (const auto& v : list)
    for (double x : v) values.push_back(x);
  return values;
}

/// Compares all classes; each may differ by `kTolerance` of its largest entry. Gaussians on a clamp's edge
/// are left out.
void compare_with_oracle(const reference::Scene& scene, Upstream which, PoseGradientKind kind,
                         const TileShape& shape, DepthModel model = DepthModel::Plane) {
  constexpr double kTolerance = 2e-3;
  reference::Settings settings;
  settings.plane_depth = model == DepthModel::Plane;
  settings.background = {0.1f, 0.2f, 0.3f};
  const reference::Gaussians gaussians(scene.cloud);
  const auto images = reference::render(gaussians, scene.camera, scene.depth, settings);
  const auto upstream = random_upstream(images, which, 5);
  const auto terms =
      kind == PoseGradientKind::Full ? reference::PoseTerms::full : reference::PoseTerms::light;
  const auto want = reference::backward(gaussians, scene.camera, scene.depth, upstream, settings, terms);
  const DeviceGradients got = run_device(scene, upstream, kind, shape, model);

  const auto check = [&](const std::string& name, const std::vector<double>& device,
                         std::vector<double> oracle, double floor = 1e-12) {
    CAPTURE(name);
    CAPTURE(static_cast<int>(which));
    REQUIRE(device.size() == oracle.size());
    const std::size_t per = device.size() / images.gaussian_edge.size();
    const double scale = magnitude(oracle, floor);
    for (std::size_t i = 0; i < oracle.size(); ++i)
      if (images.gaussian_edge[i / per]) oracle[i] = device[i];
    CHECK(largest_difference(device, oracle, scale) < kTolerance);
  };
  check("means", got.means, flat_eigen(want.means));
  check("log scales", got.log_scales, flat_eigen(want.log_scales));
  // Turning a sphere changes nothing: the scales' gradients tell how large a rounding error may look.
  check("rotations", got.rotations, flat_eigen(want.rotations), magnitude(got.log_scales));
  check("opacity", got.opacity_logits, want.opacity_logits);
  check("sh", got.sh, want.sh);
  // A Gaussian that had a part in a pixel has been seen with pixels as fine as the camera's there.
  const Intrinsics& k = scene.camera.intrinsics;
  for (std::size_t i = 0; i < gaussians.size(); ++i) {
    if (images.gaussian_edge[i]) continue;
    const double width = (scene.camera.world_to_camera * gaussians.means[i]).z() / std::sqrt(k.fx * k.fy);
    const double finest =
        want.opacity_logits[i] != 0 ? std::min(width, gaussians.sampling[i]) : gaussians.sampling[i];
    CHECK(got.sampling[i] == doctest::Approx(finest).epsilon(1e-5));
  }
  std::vector<double> pose =
      flat_eigen(std::vector<Eigen::Vector3d>{want.pose_rotation, want.pose_translation});
  bool any_edge = false;
  for (auto edge : images.gaussian_edge) any_edge |= edge != 0;
  if (any_edge) return;
  CHECK(largest_difference(got.pose, pose, magnitude(pose)) < kTolerance);
  CHECK(largest_difference(got.tracking_pose, pose, magnitude(pose)) < kTolerance);
}

}  // namespace

TEST_CASE("gradients of every output for every parameter and the pose agree with the oracle") {
  const TileShape shape = TileShape::for_device(testing::device());
  for (Upstream which : {Upstream::Colour, Upstream::Opacity, Upstream::Depth, Upstream::Normalised,
                         Upstream::Median, Upstream::Uncertainty, Upstream::All})
    for (int degree : {0, 2}) {
      CAPTURE(degree);
      compare_with_oracle(
          reference::random_scene(3, 80, {.kind = SceneKind::anisotropic, .sh_degree = degree}), which,
          PoseGradientKind::Full, shape);
    }
}

TEST_CASE("gradients on every kind of scene, full and light, with the depth of a plane or of the centre") {
  const TileShape shape = TileShape::for_device(testing::device());
  uint32_t seed = 50;
  for (SceneKind kind : reference::all_scene_kinds) {
    CAPTURE(static_cast<int>(kind));
    const auto scene = reference::random_scene(++seed, 120, {.kind = kind, .sh_degree = 3});
    compare_with_oracle(scene, Upstream::All, PoseGradientKind::Full, shape);
    compare_with_oracle(scene, Upstream::All, PoseGradientKind::Light, shape);
    compare_with_oracle(scene, Upstream::All, PoseGradientKind::Full, shape, DepthModel::Centre);
  }
}

TEST_CASE("gradients in tiny and odd images, and with large tiles") {
  const TileShape large{.width = 16, .height = 16, .lanes = testing::device().limits().subgroup_size};
  for (auto [width, height] : {std::pair{1, 1}, {7, 9}, {61, 43}}) {
    const auto scene = reference::random_scene(71, 60, {.width = width, .height = height});
    compare_with_oracle(scene, Upstream::All, PoseGradientKind::Full,
                        TileShape::for_device(testing::device()));
    compare_with_oracle(scene, Upstream::All, PoseGradientKind::Full, large);
  }
}

TEST_CASE("two backward passes give the same bits") {
  const auto scene =
      reference::random_scene(81, 2000, {.kind = SceneKind::mixed, .width = 128, .height = 96});
  reference::ImageGradients upstream(128, 96);
  for (std::size_t i = 0; i < upstream.opacity.size(); ++i) upstream.colour[3 * i] = upstream.depth[i] = 0.5;
  const TileShape shape = TileShape::for_device(testing::device());
  const auto first = run_device(scene, upstream, PoseGradientKind::Full, shape);
  const auto second = run_device(scene, upstream, PoseGradientKind::Full, shape);
  CHECK(first.means == second.means);
  CHECK(first.rotations == second.rotations);
  CHECK(first.opacity_logits == second.opacity_logits);
  CHECK(first.pose == second.pose);
  CHECK(first.tracking_pose == second.tracking_pose);
}
