#include <doctest/doctest.h>

#include <cmath>

#include "engine/gpu/recorder.h"
#include "engine/splat/densifier.h"
#include "engine/splat/mapper.h"
#include "tests/reference/losses.h"
#include "tests/reference/scenes.h"
#include "tests/reference/splatting.h"
#include "tests/splat/compare.h"
#include "tests/splat/wall.h"
#include "tests/support/device.h"

using namespace surefield;
using testing::frame_of;
using testing::Seen;
using testing::wall;
using testing::wall_camera;

namespace {

/// Adam as in the paper of Kingma and Ba, in double precision, for one number.
struct ReferenceAdam {
  double m = 0, v = 0;
  int t = 0;

  double step(double g, double rate) {
    ++t;
    m = 0.9 * m + 0.1 * g;
    v = 0.999 * v + 0.001 * g * g;
    return -rate * (m / (1 - std::pow(0.9, t))) / (std::sqrt(v / (1 - std::pow(0.999, t))) + 1e-15);
  }
};

}  // namespace

TEST_CASE("Adam on the map follows the reference, for visible Gaussians alone") {
  gpu::Device& device = testing::device();
  Rasteriser rasteriser(device);
  Mapper mapper(device);
  GaussianMap map(device);
  const auto scene =
      reference::random_scene(3, 60, {.kind = reference::SceneKind::behind_camera, .sh_degree = 1});
  map.assign(scene.cloud);
  std::vector<uint8_t> bytes(scene.colour.size(), 128);
  const SensorFrame frame(device, {scene.camera.intrinsics.width, scene.camera.intrinsics.height,
                                   bytes.data(), scene.depth.data()});
  CameraVariable camera(device, scene.camera);
  MappingSettings settings;
  std::vector<ReferenceAdam> mean_adam(scene.cloud.size()), logit_adam(scene.cloud.size()),
      sh_adam(scene.cloud.size());
  gpu::Recorder recorder(device);
  for (int step = 0; step < 3; ++step) {
    const GaussianCloud before = map.download();
    mapper.record_step(recorder, rasteriser, map, {frame, camera}, settings, 0.006);
    recorder.submit();
    const GaussianCloud after = map.download();
    const auto gradients = rasteriser.gaussian_gradients.download(map.size());
    const auto sh_gradients = rasteriser.sh_gradients.download(map.size() * 4);
    const uint32_t visible = rasteriser.lists.read_status().visible;
    std::vector<bool> is_visible(map.size(), false);
    for (uint32_t id : rasteriser.lists.visible_ids.download(visible)) is_visible[id] = true;
    REQUIRE(visible > 5);
    REQUIRE(visible < map.size());
    for (uint32_t i = 0; i < map.size(); ++i) {
      if (!is_visible[i]) {
        CHECK(after.means[i] == before.means[i]);
        CHECK(after.opacity_logits[i] == before.opacity_logits[i]);
        continue;
      }
      const double mean = before.means[i].x() + mean_adam[i].step(gradients[i].mean.x, 0.1 * 0.006);
      CHECK(after.means[i].x() == doctest::Approx(mean).epsilon(1e-5));
      const double logit = before.opacity_logits[i] + logit_adam[i].step(gradients[i].opacity_logit, 5e-2);
      CHECK(after.opacity_logits[i] == doctest::Approx(logit).epsilon(1e-4));
      const double sh = before.sh[(i * 4 + 1) * 3] + sh_adam[i].step(sh_gradients[i * 4 + 1].x, 5e-3 / 20);
      CHECK(after.sh[(i * 4 + 1) * 3] == doctest::Approx(sh).epsilon(1e-4));
    }
  }
}

TEST_CASE("a step that finds the lists of the step before does the same") {
  gpu::Device& device = testing::device();
  const auto scene = reference::random_scene(3, 300, {.width = 83, .height = 61});
  std::vector<uint8_t> bytes(scene.colour.size(), 128);
  const SensorFrame frame(device, {scene.camera.intrinsics.width, scene.camera.intrinsics.height,
                                   bytes.data(), scene.depth.data()});
  const auto after_steps = [&](bool again, int steps, const MappingSettings& settings) {
    Rasteriser rasteriser(device);
    Mapper mapper(device);
    GaussianMap map(device);
    map.assign(scene.cloud);
    CameraVariable camera(device, scene.camera);
    gpu::Recorder recorder(device);
    int served = 0;
    rasteriser.lists.forget();
    rasteriser.lists.submit(recorder, steps, [&](std::size_t) {
      const bool same = again && rasteriser.lists.serve(camera.camera);
      served += same;
      mapper.record_step(recorder, rasteriser, map, {frame, camera, false, same}, settings, 0.006);
    });
    // A fourth of the steps make lists.
    CHECK(served == (again ? steps - (steps + 3) / 4 : 0));
    CHECK(rasteriser.lists.read_status().overflow == 0);
    return map.download();
  };
  // While nothing moves, not a bit differs; where it does, only at the fringe of what has grown.
  MappingSettings still;
  still.rate_centre = still.rate_size = still.rate_rotation = still.rate_opacity = 0;
  CHECK(after_steps(true, 3, still).sh == after_steps(false, 3, still).sh);
  const GaussianCloud once = after_steps(false, 9, {}), again = after_steps(true, 9, {});
  double moved = 0, apart = 0;
  for (std::size_t i = 0; i < once.size(); ++i) {
    moved += (once.means[i] - scene.cloud.means[i]).norm();
    apart += (once.means[i] - again.means[i]).norm();
  }
  CHECK(moved > 0);
  CHECK(apart < 0.02 * moved);
}

TEST_CASE("lists that were put aside are those of their view when they are taken out again") {
  gpu::Device& device = testing::device();
  const auto scene = reference::random_scene(3, 300, {.width = 83, .height = 61});
  Camera small = scene.camera;
  small.intrinsics = scene.camera.intrinsics.scaled(0.5);
  const auto frame_of_camera = [&](const Camera& camera) {
    const std::vector<uint8_t> colour(3u * camera.intrinsics.width * camera.intrinsics.height, 128);
    const std::vector<float> depth(colour.size() / 3, 2.0f);
    return SensorFrame(device,
                       {camera.intrinsics.width, camera.intrinsics.height, colour.data(), depth.data()});
  };
  const SensorFrame frames[] = {frame_of_camera(scene.camera), frame_of_camera(small)};
  MappingSettings still;
  still.rate_centre = still.rate_size = still.rate_rotation = still.rate_opacity = 0;
  const auto colours_after = [&](bool keep) {
    Rasteriser rasteriser(device);
    Mapper mapper(device);
    GaussianMap map(device);
    map.assign(scene.cloud);
    CameraVariable cameras[] = {CameraVariable(device, scene.camera), CameraVariable(device, small)};
    ViewLists aside(device);
    gpu::Recorder recorder(device);
    int served = 0;
    rasteriser.lists.submit(recorder, 6, [&](std::size_t step) {
      if (keep && step > 0) rasteriser.lists.exchange(aside);
      const bool same = keep && rasteriser.lists.serve(cameras[step % 2].camera);
      served += same;
      mapper.record_step(recorder, rasteriser, map, {frames[step % 2], cameras[step % 2], false, same}, still,
                         0.006);
    });
    CHECK(served == (keep ? 4 : 0));
    return map.download().sh;
  };
  CHECK(colours_after(true) == colours_after(false));
}

TEST_CASE("the isotropy loss adds its gradient, above its epsilon alone") {
  gpu::Device& device = testing::device();
  Rasteriser rasteriser(device);
  GaussianMap map(device);
  const auto scene = reference::random_scene(13, 50, {.kind = reference::SceneKind::anisotropic});
  map.assign(scene.cloud);
  rasteriser.render(map, scene.camera);
  gpu::Array<glsl::CameraState> camera(device, "camera");
  const glsl::CameraState state = to_device(scene.camera);
  camera.upload(std::span(&state, 1));
  gpu::Array<float> depth(device, "depth");
  depth.upload(std::vector<float>(state.width * state.height, 0.0f));
  gpu::Recorder recorder(device);
  rasteriser.record_forward(recorder, map, {{state.width, state.height}, camera, depth}, Outputs::All);
  recorder.submit();
  rasteriser.pixel_upstream.upload(std::vector<glsl::PixelUpstream>(state.width * state.height));
  int penalised[2] = {0, 0};
  for (const float epsilon : {1.0f, 3.0f}) {
    CAPTURE(epsilon);
    rasteriser.record_backward(recorder, map, {{state.width, state.height}, camera, depth},
                               PoseGradientKind::Full, {.weight = 0.7f, .epsilon = epsilon});
    recorder.submit();

    const uint32_t visible = rasteriser.lists.read_status().visible;
    std::vector<uint8_t> flags(map.size(), 0);
    for (uint32_t id : rasteriser.lists.visible_ids.download(visible)) flags[id] = 1;
    const reference::Gaussians gaussians(scene.cloud);
    const reference::Images images = reference::render(gaussians, scene.camera, {});
    const auto want = reference::mapping_loss(images, {scene.colour, scene.depth}, gaussians, flags,
                                              {.colour = 0,
                                               .ssim = 0,
                                               .depth = 0,
                                               .align = 0,
                                               .isotropy = 0.7,
                                               .variance = 0,
                                               .isotropy_epsilon = epsilon});
    const auto got = rasteriser.gaussian_gradients.download(map.size());
    for (uint32_t i = 0; i < map.size(); ++i) {
      if (!flags[i]) continue;
      penalised[epsilon > 1] += want.log_scales[i].norm() > 0;
      CHECK(got[i].log_scale.x == doctest::Approx(want.log_scales[i].x()).epsilon(1e-4));
      CHECK(got[i].log_scale.y == doctest::Approx(want.log_scales[i].y()).epsilon(1e-4));
      CHECK(got[i].log_scale.z == doctest::Approx(want.log_scales[i].z()).epsilon(1e-4));
    }
  }
  CHECK(penalised[1] > 0);
  CHECK(penalised[1] < penalised[0]);
}

TEST_CASE("mapping lowers the loss and refines poses beside the map") {
  SplatEngine engine({.device = std::getenv("SUREFIELD_DEVICE") ? std::getenv("SUREFIELD_DEVICE") : ""});
  gpu::Device& device = testing::device();
  Rasteriser rasteriser(device);
  GaussianMap truth(device);
  truth.assign(wall(120, 90, 90));
  const Camera camera = wall_camera();
  const Seen seen(rasteriser.render(truth, camera));

  GaussianCloud dull = wall(120, 90, 90);
  for (float& c : dull.sh) c *= 0.3f;
  engine.assign(dull);
  const FrameHandle frame = engine.load(seen.view());
  Camera moved = camera;
  moved.world_to_camera.translation().x() += 0.004;
  std::vector<MappingView> views{{frame, camera, false}, {frame, moved, true}};
  const std::vector<int> once{0}, both{0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1};
  const MappingSettings settings{.rate_pose_rotation = 0.0005, .rate_pose_translation = 0.0007};
  const double first = engine.optimise(views, once, settings, 0.006).loss;
  const double last = engine.optimise(views, both, settings, 0.006).loss;
  CHECK(last < first);
  CHECK(views[0].camera.world_to_camera.isApprox(camera.world_to_camera));
  CHECK(std::abs(views[1].camera.world_to_camera.translation().x()) < 0.004);
}

TEST_CASE("densification plans: keep, clone, split, prune") {
  const std::vector<GaussianStatistics> statistics{
      {.opacity = 0.5f, .largest_scale = 0.001f, .screen_gradient = 0},    // kept
      {.opacity = 0.001f, .largest_scale = 0.001f, .screen_gradient = 1},  // too faint
      {.opacity = 0.5f, .largest_scale = 0.001f, .screen_gradient = 1},    // small: cloned
      {.opacity = 0.5f, .largest_scale = 0.05f, .screen_gradient = 1},     // large: split
      {.opacity = 0.5f, .largest_scale = 5.0f, .screen_gradient = 0},      // huge
      {.opacity = NAN, .largest_scale = 0.001f, .screen_gradient = 0}};    // not a number
  const DensifyPlan plan = plan_densification(statistics, {.extent = 2});
  CHECK(plan.sources == std::vector<uint32_t>{0u | glsl::SOURCE_KEPT, 2u | glsl::SOURCE_KEPT,
                                              2u | glsl::SOURCE_CLONE, 3u | glsl::SOURCE_SPLIT,
                                              3u | glsl::SOURCE_SPLIT});
  CHECK(plan.result.pruned == 3);
  CHECK(plan.result.cloned == 1);
  CHECK(plan.result.split == 1);
}

TEST_CASE("densification rebuilds the map as planned and is reproducible") {
  gpu::Device& device = testing::device();
  Densifier densifier(device);
  const auto scene = reference::random_scene(5, 300, {.sh_degree = 1});
  const auto run = [&] {
    GaussianMap map(device);
    map.assign(scene.cloud);
    std::vector<glsl::vec2> statistics(300);
    for (std::size_t i = 0; i < 300; i += 3) statistics[i] = {2.0f, 1.0f};
    map.densification.upload(statistics);
    const DensifyResult result = densifier.densify(map, {.maximum_scale = 1e6, .extent = 0.1, .seed = 7});
    CHECK(map.size() == 300 - result.pruned + result.cloned + result.split);
    CHECK(result.split + result.cloned > 50);
    return map.download();
  };
  const GaussianCloud first = run(), second = run();
  CHECK(first.means == second.means);
  CHECK(first.sh == second.sh);
  // Children come last, in pairs, smaller than their parent and near it.
  const std::size_t last = first.size() - 1;
  bool found = false;
  for (std::size_t i = 0; i < scene.cloud.size(); ++i) {
    const Eigen::Vector3f shrunk = scene.cloud.log_scales[i] - Eigen::Vector3f::Constant(std::log(1.6f));
    if (!shrunk.isApprox(first.log_scales[last], 1e-5f)) continue;
    found = true;
    const float reach = 6 * std::exp(scene.cloud.log_scales[i].maxCoeff());
    CHECK((first.means[last] - scene.cloud.means[i]).norm() < reach);
    CHECK(first.means[last] != first.means[last - 1]);
  }
  CHECK(found);
}

TEST_CASE("a view without room changes nothing, and what was recorded before it counts") {
  gpu::Device& device = testing::device();
  Rasteriser rasteriser(device);
  Mapper mapper(device);
  GaussianMap map(device);
  const auto scene = reference::random_scene(
      41, 500, {.kind = reference::SceneKind::larger_than_image, .width = 400, .height = 300});
  map.assign(scene.cloud);
  const auto frame_of_size = [&](int width, int height) {
    const std::vector<uint8_t> colour(3 * width * height, 100);
    const std::vector<float> depth(width * height, 2.0f);
    return SensorFrame(device, {width, height, colour.data(), depth.data()});
  };
  Camera small = scene.camera;
  small.intrinsics = scene.camera.intrinsics.scaled(0.05);
  const SensorFrame large_frame = frame_of_size(400, 300);
  const SensorFrame small_frame = frame_of_size(small.intrinsics.width, small.intrinsics.height);
  CameraVariable large_camera(device, scene.camera), small_camera(device, small);

  gpu::Recorder recorder(device);
  const auto record = [&](bool large) {
    mapper.record_step(recorder, rasteriser, map,
                       {large ? large_frame : small_frame, large ? large_camera : small_camera, true}, {},
                       0.003);
  };
  rasteriser.lists.submit(recorder, 1, [&](std::size_t) { record(false); });
  const GaussianCloud after_one = map.download();
  map.assign(scene.cloud);
  // The large view overflows; the small ones after it must wait, although they would fit.
  std::vector<std::size_t> recorded;
  rasteriser.lists.submit(recorder, 4, [&](std::size_t step) {
    recorded.push_back(step);
    if (recorded.size() == 5) {
      CHECK(map.download().means == after_one.means);
      for (const glsl::vec2& seen : map.densification.download(map.size())) CHECK(seen.y <= 1);
    }
    record(step == 1);
  });
  CHECK(recorded == std::vector<std::size_t>{0, 1, 2, 3, 1, 2, 3});
  CHECK(map.download().means != after_one.means);
}
