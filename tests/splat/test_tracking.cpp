#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <functional>

#include "engine/gpu/recorder.h"
#include "engine/splat/adam_tracker.h"
#include "engine/splat/engine.h"
#include "engine/splat/gauss_newton_tracker.h"
#include "engine/types/error.h"
#include "tests/splat/wall.h"
#include "tests/support/device.h"

using namespace surefield;
using testing::frame_of;
using testing::Seen;
using testing::wall;
using testing::wall_camera;

namespace {

/// How far apart two poses are.
struct PoseError {
  double metres, radians;
};

PoseError error_of(const TrackingResult& result, const Camera& truth) {
  const Pose error = result.world_to_camera * truth.world_to_camera.inverse();
  return {error.translation().norm(), Eigen::AngleAxisd(error.rotation()).angle()};
}

/// The wall's camera, moved and turned.
Camera moved(double metres, double radians) {
  Camera camera = wall_camera();
  camera.world_to_camera = Eigen::Translation3d(metres * Eigen::Vector3d(0.6, -0.5, 0.62)) *
                           Eigen::AngleAxisd(radians, Eigen::Vector3d(1, -2, 0.5).normalized());
  return camera;
}

/// A wall on the device, and everything that tracks against it.
struct Track {
  gpu::Device& device = testing::device();
  Rasteriser rasteriser{device};
  TrackingLoss loss{device};
  GaussianMap map{device};

  template <class Method>
  TrackingResult run(Method&& tracker, const SensorFrame& frame, const Camera& start,
                     const TrackingSettings& settings) {
    return tracker.track(rasteriser, loss, map, frame, start, settings);
  }
};

}  // namespace

TEST_CASE("Adam recovers a pose from a perturbed start") {
  Track t;
  t.map.assign(wall(120, 90, 90));
  const SensorFrame frame = frame_of(t.device, t.rasteriser, t.map, wall_camera());
  for (PoseGradientKind kind : {PoseGradientKind::Full, PoseGradientKind::Light}) {
    const TrackingResult result =
        t.run(AdamTracker(t.device), frame, moved(0.017, 0.01),
              {.minimum_opacity = 0.9, .adam = {.iterations = 80, .pose_gradient = kind}});
    const PoseError error = error_of(result, wall_camera());
    CHECK(error.metres < 2e-3);
    CHECK(error.radians < 1e-3);
    CHECK(result.iterations <= 80);
    CHECK(result.valid_fraction > 0.5);
  }
}

TEST_CASE("Gauss-Newton recovers a pose from near and far, with either depth") {
  Track t;
  t.map.assign(wall(160, 120, 90));
  const SensorFrame frame = frame_of(t.device, t.rasteriser, t.map, wall_camera());
  for (DepthKind depth : {DepthKind::Alpha, DepthKind::Normalised})
    for (const auto& start : {std::pair{0.01, 0.017}, {0.03, 0.05}, {0.1, 0.05}}) {
      CAPTURE(start.first);
      const TrackingResult result =
          t.run(GaussNewtonTracker(t.device), frame, moved(start.first, start.second),
                {.minimum_opacity = 0.9, .depth = depth, .gauss_newton = {.renders = 8}});
      const PoseError error = error_of(result, wall_camera());
      CHECK(error.metres < 1e-3);
      CHECK(error.radians < 5e-4);
      CHECK(result.iterations <= 8);
      CHECK(result.valid_fraction > 0.5);
    }
}

TEST_CASE("a frame is aligned to another one alone, whatever the map, and tells how certain that is") {
  SplatEngine engine({.device = testing::device_options().selector});
  engine.assign(wall(200, 160, 90));
  const Camera there = moved(0.04, 0.03);
  const auto load = [&](const Camera& camera) { return engine.load(Seen(engine.render(camera)).view()); };
  const FrameHandle here_frame = load(wall_camera()), there_frame = load(there);
  engine.assign({});
  const Camera elsewhere{wall_camera().intrinsics, Pose(Eigen::Translation3d(7, 1, -3))};
  const Pose to_there = there.world_to_camera * wall_camera().world_to_camera.inverse();
  // The two are where the first is said to be.
  const PairAlignment found =
      engine.align(there_frame, elsewhere, {here_frame, elsewhere}, {.minimum_opacity = 0.9});
  const Pose error =
      found.world_to_camera * elsewhere.world_to_camera.inverse() * to_there.inverse();
  CHECK(error.translation().norm() < 1e-3);
  CHECK(Eigen::AngleAxisd(error.rotation()).angle() < 5e-4);
  CHECK(found.evidence.information.ldlt().isPositive());
  CHECK(found.evidence.information.diagonal().minCoeff() > 0);
  Camera smaller = elsewhere;
  smaller.intrinsics.width /= 2;
  CHECK_THROWS_AS(engine.align(there_frame, elsewhere, {here_frame, smaller}, {}), UsageError);
}

TEST_CASE("a frame near one whose render was kept is aligned to that, until the map changes") {
  Track t;
  const GaussianCloud cloud = wall(160, 120, 90);
  GaussianCloud shifted = cloud;
  for (Eigen::Vector3f& mean : shifted.means) mean.x() += 0.006f;
  t.map.assign(cloud);
  const Camera here = wall_camera(), near = moved(0.02, 0.02), far = moved(0.15, 0.01);
  const SensorFrame frame = frame_of(t.device, t.rasteriser, t.map, here);
  const SensorFrame near_frame = frame_of(t.device, t.rasteriser, t.map, near);
  const SensorFrame far_frame = frame_of(t.device, t.rasteriser, t.map, far);
  // One alignment a frame. What it is aligned to shows in the pose, since the map is shifted unnoticed.
  const TrackingSettings settings{.minimum_opacity = 0.9, .gauss_newton = {.renders = 1}};
  const auto error_after = [&](const SensorFrame& next, const Camera& start, const Camera& truth,
                               const auto& before) {
    GaussNewtonTracker tracker(t.device);
    t.map.assign(cloud);
    CHECK(error_of(t.run(tracker, frame, here, settings), here).metres < 1e-3);
    before(tracker);
    t.map.assign(shifted);
    const TrackingResult result = t.run(tracker, next, start, settings);
    CHECK(result.iterations == 1);
    return error_of(result, truth).metres;
  };
  const auto keep = [](GaussNewtonTracker& tracker) { tracker.keep_render(); };
  CHECK(error_after(near_frame, here, near, keep) < 1e-3);
  CHECK(error_after(near_frame, near, near, keep) < 1e-3);
  CHECK(error_after(near_frame, near, near, [](GaussNewtonTracker&) {}) > 4e-3);
  CHECK(error_after(near_frame, near, near, [&](GaussNewtonTracker& tracker) {
          keep(tracker);
          tracker.forget_render();
        }) > 4e-3);
  CHECK(error_after(far_frame, far, far, keep) > 4e-3);
}

TEST_CASE("the engine renders a map that has changed again") {
  const GaussianCloud cloud = wall(160, 120, 90);
  GaussianCloud shifted = cloud;
  for (Eigen::Vector3f& mean : shifted.means) mean.x() += 0.006f;
  const Camera here = wall_camera();
  const TrackingSettings settings{.minimum_opacity = 0.9, .gauss_newton = {.renders = 1}};
  const auto change_after = [&](const std::function<void(SplatEngine&, FrameHandle)>& change) {
    SplatEngine engine({.device = testing::device_options().selector});
    engine.assign(cloud);
    const FrameHandle frame = engine.load(Seen(engine.render(here)).view());
    engine.track(frame, here, settings);
    engine.keep_render();
    const Pose again = engine.track(frame, here, settings).world_to_camera;
    change(engine, frame);
    const Pose after = engine.track(frame, here, settings).world_to_camera;
    return (after * again.inverse()).translation().norm();
  };
  CHECK(change_after([](SplatEngine&, FrameHandle) {}) < 2e-4);
  CHECK(change_after([&](SplatEngine& engine, FrameHandle) { engine.assign(shifted); }) > 1e-3);
  CHECK(change_after([&](SplatEngine& engine, FrameHandle) { engine.insert(shifted); }) > 1e-3);
  CHECK(change_after([&](SplatEngine& engine, FrameHandle frame) {
          std::vector<MappingView> views{{frame, moved(0.01, 0.01)}};
          engine.optimise(views, std::vector<int>(10, 0), {}, 0.006);
        }) > 1e-3);
}

TEST_CASE("a keyframe's own images pull the pose to where they fit, where the map is off") {
  Track t;
  t.map.assign(wall(160, 120, 90));
  const Camera keyframe_camera = moved(0.02, 0.01);
  const SensorFrame frame = frame_of(t.device, t.rasteriser, t.map, wall_camera());
  const SensorFrame keyframe = frame_of(t.device, t.rasteriser, t.map, keyframe_camera);
  GaussianCloud shifted = wall(160, 120, 90);
  for (Eigen::Vector3f& mean : shifted.means) mean.x() += 0.006f;
  t.map.assign(shifted);
  GaussNewtonTracker tracker(t.device);
  const auto error = [&](std::span<const Camera> references) {
    const TrackingSettings settings{.minimum_opacity = 0.9,
                                    .gauss_newton = {.renders = 8, .reference_weight = 100}};
    return error_of(tracker.track(t.rasteriser, t.loss, t.map, frame, wall_camera(), settings, references),
                    wall_camera())
        .metres;
  };
  CHECK(error({}) > 4e-3);
  CHECK_FALSE(tracker.holds(0, 7));
  for (const std::size_t place : {0u, 1u}) tracker.hold(place, 7, keyframe, keyframe_camera.intrinsics);
  CHECK(tracker.holds(1, 7));
  const std::vector<Camera> references(2, keyframe_camera);
  CHECK(error(std::span(references).first(1)) < 1e-3);
  CHECK(error(references) < 1e-3);
}

TEST_CASE("the engine aligns frames to the keyframes that it is given, also when they or their size change") {
  SplatEngine engine({.device = testing::device_options().selector});
  const auto load = [&](const Camera& camera) { return engine.load(Seen(engine.render(camera)).view()); };
  GaussianCloud shifted = wall(160, 120, 90);
  for (Eigen::Vector3f& mean : shifted.means) mean.x() += 0.006f;
  const TrackingSettings settings{.minimum_opacity = 0.9, .gauss_newton = {.reference_weight = 100}};
  for (const double scale : {1.0, 0.5}) {
    CAPTURE(scale);
    engine.assign(wall(160, 120, 90));
    const auto at = [&](double metres, double radians) {
      Camera camera = moved(metres, radians);
      camera.intrinsics = camera.intrinsics.scaled(scale);
      return camera;
    };
    const Camera here = at(0, 0);
    const FrameHandle frame = load(here);
    std::vector<TrackingReference> keyframes;
    for (const double metres : {0.02, -0.02, 0.03, 0.01, 0.015})
      keyframes.push_back({load(at(metres, 0.01)), at(metres, 0.01)});
    const auto error = [&](std::span<const TrackingReference> references) {
      engine.assign(shifted);  // so that the map is rendered from the start again
      return error_of(engine.track(frame, here, settings, references), here).metres;
    };
    const double alone = error({});
    CHECK(alone > 4e-3);
    CHECK(error(std::span(keyframes).first(2)) < alone / 2);
    CHECK(error(std::span(keyframes).subspan(1, 3)) < alone / 2);
    CHECK(error(keyframes) < alone / 2);
    const std::vector<uint8_t> all(static_cast<std::size_t>(here.intrinsics.width) * here.intrinsics.height,
                                   1);
    for (const TrackingReference& keyframe : std::span(keyframes).first(2)) engine.hide(keyframe.frame, all);
    CHECK(error(std::span(keyframes).first(2)) == doctest::Approx(alone));
    TrackingReference other = keyframes[0];
    other.camera.intrinsics.width += 1;
    CHECK_THROWS_AS(engine.track(frame, here, settings, std::span(&other, 1)), UsageError);
  }
}

TEST_CASE("tracking against an empty map, or in a tiny image, ends with the starting pose") {
  Track t;
  GaussianMap walls(t.device);
  walls.assign(wall(60, 45, 45));
  Camera camera = wall_camera();
  const SensorFrame frame = frame_of(t.device, t.rasteriser, walls, camera);
  for (const TrackingResult& result :
       {t.run(AdamTracker(t.device), frame, camera, {.adam = {.iterations = 10}}),
        t.run(GaussNewtonTracker(t.device), frame, camera, {})}) {
    CHECK(result.world_to_camera.isApprox(camera.world_to_camera));
    CHECK(result.valid_fraction == 0);
  }
  camera.intrinsics.width = camera.intrinsics.height = 1;
  const SensorFrame dot = frame_of(t.device, t.rasteriser, walls, camera);
  CHECK(
      t.run(GaussNewtonTracker(t.device), dot, camera, {}).world_to_camera.isApprox(camera.world_to_camera));
}
