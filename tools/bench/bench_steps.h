#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/splat/adam_tracker.h"
#include "engine/splat/gauss_newton_tracker.h"
#include "engine/splat/mapper.h"
#include "tools/bench/bench_scenes.h"

namespace surefield {

/// Something to measure: `run` does it `units` times over and waits for the device; `prepare` goes before and
/// does not count.
struct BenchStep {
  std::string name;
  int units = 1;
  std::function<void()> run;
  std::function<void()> prepare = [] {};
};

/// A scene on the device and what the engine does with it, ready to be measured again and again: every step
/// leaves the map and the camera as they were.
class SceneSteps {
 public:
  SceneSteps(gpu::Device& device, const TileShape& shape, const BenchScene& scene);

  /// The steps of SceneTimes.
  std::vector<BenchStep> steps();

  /// Renders the view: tile lists and images are then those of `forward`.
  void render() { render(Outputs::ColourDepth); }
  const Rasteriser& rasteriser() const { return rasteriser_; }
  const ImageSize& size() const { return frame_.size; }

 private:
  View view() const { return {frame_.size, camera_.camera, frame_.depth}; }
  void render(Outputs outputs);
  void render_and_go_back(Outputs outputs);
  void map();
  void track(TrackingMethod method);

  gpu::Device& device_;
  Rasteriser rasteriser_;
  GaussianMap map_;
  CameraVariable camera_;
  SensorFrame frame_;
  TrackingLoss loss_;
  AdamTracker adam_;
  GaussNewtonTracker gauss_newton_;
  Mapper mapper_;
  gpu::Recorder recorder_;
  Camera start_;  ///< where tracking starts
  std::vector<glsl::PixelUpstream> upstream_;
};

}  // namespace surefield
