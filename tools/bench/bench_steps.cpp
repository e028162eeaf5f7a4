#include "tools/bench/bench_steps.h"

#include <algorithm>
#include <cmath>

namespace surefield {

namespace {

// Steps of mapping and of the Adam tracker for each submission, as the engine takes them.
constexpr int kBatch = 5;

// How far the camera has moved since the frame before: that of a hand-held camera at 30 frames a second.
constexpr double kTurn = 0.006;   // radians
constexpr double kShift = 0.008;  // metres

/// A gradient for every pixel, without meaning but with no zeros.
std::vector<glsl::PixelUpstream> some_upstream(uint64_t pixels) {
  std::vector<glsl::PixelUpstream> upstream(pixels);
  for (uint64_t i = 0; i < pixels; ++i) {
    const float x = std::sin(static_cast<float>(i % 1000)), y = std::cos(static_cast<float>(i % 777));
    upstream[i] = {.colour = {x, y, x * y},
                   .depth = x,
                   .constant = 0.5f * y,
                   .total = y,
                   .median = 0.1f * x,
                   .uncertainty = 0.1f * y};
  }
  return upstream;
}

/// The scene with the map's own images in the place of a sensor's where it has none.
BenchScene with_sensor(Rasteriser& rasteriser, const GaussianMap& map, BenchScene scene) {
  if (!scene.sensor_colour.empty()) return scene;
  const RenderImages images = rasteriser.render(map, scene.camera);
  for (float value : images.colour)
    scene.sensor_colour.push_back(static_cast<uint8_t>(std::lround(255 * std::clamp(value, 0.0f, 1.0f))));
  scene.sensor_depth.clear();
  for (std::size_t i = 0; i < images.opacity.size(); ++i)
    scene.sensor_depth.push_back(images.opacity[i] > 0.5f ? images.depth_normalised[i] : 0.0f);
  return scene;
}

SensorFrame load_frame(gpu::Device& device, const BenchScene& scene) {
  return {device,
          {.width = scene.camera.intrinsics.width,
           .height = scene.camera.intrinsics.height,
           .colour = scene.sensor_colour.data(),
           .depth = scene.sensor_depth.data()}};
}

GaussianMap load_map(gpu::Device& device, const GaussianCloud& cloud) {
  GaussianMap map(device);
  map.assign(cloud);
  return map;
}

Camera moved(Camera camera) {
  const Eigen::Vector3d direction = Eigen::Vector3d(1, -1, 1).normalized();
  camera.world_to_camera = Eigen::Translation3d(kShift * direction) *
                           Eigen::AngleAxisd(kTurn, Eigen::Vector3d(1, 1, -1).normalized()) *
                           camera.world_to_camera;
  return camera;
}

/// Settings with which all the work is done and nothing moves.
MappingSettings still_mapping() {
  MappingSettings settings;
  settings.rate_centre = settings.rate_size = settings.rate_rotation = 0;
  settings.rate_opacity = settings.rate_colour = 0;
  settings.rate_pose_rotation = settings.rate_pose_translation = 0;
  return settings;
}

}  // namespace

SceneSteps::SceneSteps(gpu::Device& device, const TileShape& shape, const BenchScene& scene)
    : device_(device),
      rasteriser_(device, shape),
      map_(load_map(device, scene.cloud)),
      camera_(device, scene.camera),
      frame_(load_frame(device, with_sensor(rasteriser_, map_, scene))),
      loss_(device),
      adam_(device),
      gauss_newton_(device),
      mapper_(device),
      recorder_(device),
      start_(moved(scene.camera)),
      upstream_(some_upstream(frame_.size.pixels())) {
  rasteriser_.lists.submit(
      recorder_, 1, [&](std::size_t) { rasteriser_.record_forward(recorder_, map_, view(), Outputs::All); });
}

void SceneSteps::render(Outputs outputs) {
  rasteriser_.record_forward(recorder_, map_, view(), outputs);
  recorder_.submit();
}

void SceneSteps::render_and_go_back(Outputs outputs) {
  rasteriser_.record_forward(recorder_, map_, view(), outputs);
  if (outputs == Outputs::All)
    rasteriser_.record_backward(recorder_, map_, view(), PoseGradientKind::Full, {.weight = 0.1f});
  else
    rasteriser_.record_backward_pose(recorder_, map_, view(), PoseGradientKind::Full, outputs);
  recorder_.submit();
}

void SceneSteps::map() {
  rasteriser_.lists.submit(recorder_, kBatch, [&](std::size_t) {
    mapper_.record_step(recorder_, rasteriser_, map_, {frame_, camera_, true}, still_mapping(), 1);
  });
}

void SceneSteps::track(TrackingMethod method) {
  const TrackingSettings settings{.method = method, .adam = {.iterations = kBatch, .stop_below = 0}};
  if (method == TrackingMethod::Adam)
    adam_.track(rasteriser_, loss_, map_, frame_, start_, settings);
  else
    gauss_newton_.track(rasteriser_, loss_, map_, frame_, start_, settings);
}

std::vector<BenchStep> SceneSteps::steps() {
  // The losses leave gradients behind that differ from scene to scene.
  const auto prepare = [this] {
    rasteriser_.pixel_upstream.upload(upstream_);
    device_.finish_uploads();
  };
  return {{"forward", 1, [this] { render(Outputs::ColourDepth); }},
          {"forward_all", 1, [this] { render(Outputs::All); }},
          {"forward_pose", 1, [this] { render_and_go_back(Outputs::ColourDepth); }, prepare},
          {"forward_full", 1, [this] { render_and_go_back(Outputs::All); }, prepare},
          {"mapping", kBatch, [this] { map(); }},
          {"tracking_adam", kBatch, [this] { track(TrackingMethod::Adam); }},
          {"tracking_gauss_newton", 1, [this] { track(TrackingMethod::GaussNewton); }}};
}

}  // namespace surefield
