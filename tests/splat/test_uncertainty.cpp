#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "engine/gpu/recorder.h"
#include "engine/splat/map_rebuild.h"
#include "engine/splat/uncertainty.h"
#include "engine/types/error.h"
#include "tests/reference/scenes.h"
#include "tests/reference/splatting.h"
#include "tests/reference/uncertainty.h"
#include "tests/splat/wall.h"
#include "tests/support/device.h"

using namespace surefield;
using testing::Seen;
using testing::wall;
using testing::wall_camera;

namespace {

const DepthNoise kNoise = noise_of(DepthSensor::StructuredLight);  // the default of frames
const float kLowLogit = static_cast<float>(std::log(0.01 / 0.99));

/// A view of a scene; pixels in which float and double may decide differently have no sensor depth.
struct JudgedView {
  Camera camera;
  reference::Images images;
  std::vector<float> depth;

  JudgedView(const reference::Gaussians& gaussians, const Camera& from, std::vector<float> sensor)
      : camera(from), images(reference::render(gaussians, from, sensor)), depth(std::move(sensor)) {
    for (std::size_t p = 0; p < depth.size(); ++p)
      if (images.blend_edge[p] || images.dominator_edge[p] || depth[p] > 10) depth[p] = 0;
  }
};

/// Judges a map from views on the device.
struct Court {
  gpu::Device& device = testing::device();
  Rasteriser rasteriser{device};
  UncertaintyJudge judge{device};
  GaussianMap map{device};

  /// Adds one view; returns how often it had to be recorded.
  int add(const Camera& camera, const std::vector<float>& depth, double above) {
    const int width = camera.intrinsics.width, height = camera.intrinsics.height;
    const std::vector<uint8_t> colour(3 * depth.size(), 100);
    const SensorFrame frame(device, {width, height, colour.data(), depth.data()});
    gpu::Array<glsl::CameraState> state(device, "camera");
    const glsl::CameraState host = to_device(camera);
    state.upload(std::span(&host, 1));
    gpu::Recorder recorder(device);
    int times = 0;
    rasteriser.lists.submit(recorder, 1, [&](std::size_t) {
      judge.record_view(recorder, rasteriser, map, frame, state, {.uncertainty_above = above});
      ++times;
    });
    return times;
  }

  void begin() {
    gpu::Recorder recorder(device);
    judge.record_begin(recorder, map);
    recorder.submit();
  }

  uint32_t verdict(const MappingSettings& settings) {
    gpu::Recorder recorder(device);
    judge.record_verdict(recorder, map, settings);
    recorder.submit();
    return judge.read_uncertain();
  }
};

/// A wall with one Gaussian hanging a metre in front of it, the last of the cloud, as large as ten pixels.
GaussianCloud wall_and_stray() {
  GaussianCloud cloud = wall(120, 90, 90);
  cloud.resize(cloud.size() + 1);
  cloud.means.back() = {0.05f, -0.02f, 1};
  cloud.log_scales.back().setConstant(std::log(0.05f));
  cloud.opacity_logits.back() = 3;
  return cloud;
}

/// An engine, and a frame of the wall alone.
struct Stand {
  SplatEngine engine{{.device = testing::device_options().selector}};
  FrameHandle frame = 0;

  Stand() {
    engine.assign(wall(120, 90, 90));
    frame = engine.load(Seen(engine.render(wall_camera())).view());
  }
  std::vector<MappingView> views() const { return {{frame, wall_camera(), false}}; }
  void optimise(int steps, const MappingSettings& settings) {
    std::vector<MappingView> all = views();
    engine.optimise(all, std::vector<int>(static_cast<std::size_t>(steps), 0), settings, 0.006);
  }
};

/// Compares a verdict over two views with the oracle's.
void compare_with_oracle(reference::Scene scene, double above) {
  for (std::size_t i = 0; i < scene.cloud.size(); ++i)
    scene.cloud.uncertainty[i] = i % 2 ? 100.0f + static_cast<float>(i) : 0.0f;
  const reference::Gaussians gaussians(scene.cloud);
  Camera moved = scene.camera;
  moved.world_to_camera.pretranslate(Eigen::Vector3d(0.1, -0.05, 0.2));
  Court court;
  court.map.assign(scene.cloud);
  court.begin();
  std::vector<reference::DominatedPixels> dominated(scene.cloud.size());
  for (const Camera& camera : {scene.camera, moved}) {
    const JudgedView view(gaussians, camera, scene.depth);
    court.add(view.camera, view.depth, above);
    reference::add_dominated_pixels(gaussians, view.camera, view.images, view.depth, kNoise, above,
                                    dominated);
  }
  const uint32_t uncertain = court.verdict({.uncertainty_above = above});
  const GaussianCloud after = court.map.download();
  uint32_t above_limit = 0;
  for (std::size_t i = 0; i < after.size(); ++i) {
    const bool judged = dominated[i].count > 0;
    const double want = judged ? dominated[i].mean() : scene.cloud.uncertainty[i];
    CHECK(after.uncertainty[i] == doctest::Approx(want).epsilon(2e-3));
    const bool high = after.uncertainty[i] > static_cast<float>(above);
    above_limit += high;
    const float before = scene.cloud.opacity_logits[i];
    CHECK(after.opacity_logits[i] == (judged && high ? std::min(before, kLowLogit) : before));
  }
  CHECK(uncertain == above_limit);
}

}  // namespace

TEST_CASE("the uncertainty of Gaussians over two views agrees with the oracle on every kind of scene") {
  uint32_t seed = 60;
  for (const reference::SceneKind kind : reference::all_scene_kinds) {
    CAPTURE(static_cast<int>(kind));
    compare_with_oracle(reference::random_scene(++seed, 150, {.kind = kind}), 0.3);
  }
}

TEST_CASE("uncertainty in tiny and odd images, of no, one, and more Gaussians than a workgroup has lanes") {
  for (const auto& size : {std::pair{1, 1}, {1, 37}, {7, 9}, {65, 41}}) {
    CAPTURE(size.first);
    for (int count : {0, 1, 129})
      compare_with_oracle(reference::random_scene(71, count, {.width = size.first, .height = size.second}),
                          0.1);
  }
}

TEST_CASE("sums of uncertainty go on beyond 32 bits, and a view without room is not counted") {
  auto scene = reference::random_scene(
      73, 500, {.kind = reference::SceneKind::larger_than_image, .width = 400, .height = 300});
  scene.depth.assign(scene.depth.size(), 9.5f);
  Court court;
  court.map.assign(scene.cloud);
  court.begin();
  CHECK(court.add(scene.camera, scene.depth, 1e3) == 2);
  const RenderImages images = court.rasteriser.render(court.map, scene.camera);
  std::vector<double> sums(court.map.size(), 0.0);
  std::vector<uint32_t> pixels(court.map.size(), 0);
  for (std::size_t p = 0; p < images.dominator.size(); ++p) {
    const int32_t id = images.dominator[p];
    if (id < 0) continue;
    const double z = (scene.camera.world_to_camera * scene.cloud.means[id].cast<double>()).z();
    sums[id] += images.dominator_weight[p] * (9.5 - z) * (9.5 - z);
    ++pixels[id];
  }
  bool beyond = false;
  const auto got = court.judge.sums.download(court.map.size());
  for (uint32_t i = 0; i < court.map.size(); ++i) {
    CHECK(got[i].pixels == pixels[i]);
    const double sum = (got[i].high * 4294967296.0 + got[i].low) / 16777216.0;
    CHECK(sum == doctest::Approx(sums[i]).epsilon(1e-4));
    beyond = beyond || got[i].high > 1;
  }
  CHECK(beyond);
}

TEST_CASE("what is born of an uncertain Gaussian is not uncertain, what is kept is") {
  gpu::Device& device = testing::device();
  GaussianMap map(device);
  GaussianCloud cloud = wall(3, 1, 90);
  cloud.uncertainty = {0.5f, 0.25f, 0.125f};
  map.assign(cloud);
  map.append(cloud);
  MapRebuild(device).rebuild(map, std::vector<uint32_t>{5u | glsl::SOURCE_KEPT, 0u | glsl::SOURCE_KEPT,
                                                        0u | glsl::SOURCE_CLONE, 1u | glsl::SOURCE_SPLIT});
  CHECK(map.download().uncertainty == std::vector<float>{0.125f, 0.5f, 0, 0});
  // All of them are of surfaces that were seen from as near.
  CHECK(map.download().sampling ==
        std::vector<float>{cloud.sampling[2], cloud.sampling[0], cloud.sampling[0], cloud.sampling[1]});
  cloud.uncertainty.pop_back();
  CHECK_THROWS_AS(map.append(cloud), UsageError);
}

TEST_CASE(
    "a Gaussian that hangs in front of a wall loses its opacity, and is pruned since it does not regain it") {
  Stand stand;
  const GaussianCloud before = wall_and_stray();
  const std::size_t stray = before.size() - 1;
  stand.engine.assign(before);
  CHECK(stand.engine.judge(stand.views(), {}).uncertain == 1);
  const GaussianCloud after = stand.engine.map();
  CHECK(after.uncertainty[stray] > 0.1f);
  CHECK(after.opacity_logits[stray] == kLowLogit);
  for (std::size_t i = 0; i < stray; ++i) {
    REQUIRE(after.opacity_logits[i] == before.opacity_logits[i]);
    REQUIRE(after.uncertainty[i] < 0.01f);
  }
  // It dominates nothing now, and stays what it is: uncertain, and lowered no further.
  CHECK(stand.engine.judge(stand.views(), {}).uncertain == 1);
  CHECK(stand.engine.map().uncertainty[stray] == after.uncertainty[stray]);
  stand.optimise(30, {});
  CHECK(stand.engine.densify({.gradient_threshold = 1e6, .maximum_scale = 1e6}).pruned == 1);
  CHECK(stand.engine.size() == stray);
}

TEST_CASE("Gaussians that are in their place after all regain their opacity and are judged anew") {
  Stand stand;
  stand.engine.assign(wall(120, 90, 90));
  const Seen seen(stand.engine.render(wall_camera()), 0.7f);
  const std::vector<MappingView> misled{{stand.engine.load(seen.view()), wall_camera(), false}};
  const uint32_t uncertain = stand.engine.judge(misled, {}).uncertain;
  CHECK(uncertain > 1000);
  const auto regained = [&] {  // five times the opacity that was left to them
    const std::vector<float> logits = stand.engine.map().opacity_logits;
    return std::count_if(logits.begin(), logits.end(), [](float logit) { return logit > -2.94f; });
  };
  const auto low = regained();
  stand.optimise(120, {});
  CHECK(regained() > low + 1000);
  CHECK(stand.engine.judge(stand.views(), {}).uncertain < uncertain - 500);
}

TEST_CASE("uncertain Gaussians take no part in tracking, but are rendered") {
  Stand with, without;
  GaussianCloud cloud = wall_and_stray();
  cloud.uncertainty.back() = 0.03f;
  with.engine.assign(cloud);
  const Camera camera = wall_camera();
  const std::size_t centre = 34 * 96 + 52;
  CHECK(with.engine.render(camera).dominator[centre] == static_cast<int32_t>(cloud.size()) - 1);
  for (const TrackingMethod method : {TrackingMethod::GaussNewton, TrackingMethod::Adam}) {
    TrackingSettings settings{.method = method, .minimum_opacity = 0.9, .adam = {.iterations = 5}};
    const auto loss = [&](Stand& stand) { return stand.engine.track(stand.frame, camera, settings).loss; };
    CHECK(loss(with) == loss(without));
    settings.uncertainty_above = 0.04;
    CHECK(loss(with) > loss(without));
    settings.uncertainty_above = 0;
    CHECK(loss(with) > loss(without));
  }
}

TEST_CASE("where no Gaussian is judged, nothing changes") {
  Stand stand;
  GaussianCloud cloud = wall_and_stray();
  cloud.uncertainty.back() = 0.03f;
  stand.engine.assign(cloud);
  CHECK(stand.engine.judge(stand.views(), {.uncertainty_above = 0}).uncertain == 0);
  const GaussianCloud after = stand.engine.map();
  CHECK(after.opacity_logits == cloud.opacity_logits);
  CHECK(after.uncertainty == cloud.uncertainty);
}
