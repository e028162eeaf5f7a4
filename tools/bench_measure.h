#pragma once

#include <string>
#include <vector>

#include "engine/gpu/recorder.h"
#include "engine/splat/tile_lists.h"
#include "tools/bench_scenes.h"

namespace surefield {

/// Repeated measurements of one thing.
class Samples {
 public:
  void add(double value) { values_.push_back(value); }
  double median() const;
  double least() const;

 private:
  std::vector<double> values_;
};

/// Device time of all dispatches of one pass within one step.
struct PassSamples {
  std::string pass;
  int dispatches = 0;    ///< a step
  Samples milliseconds;  ///< their sum
};

/// One step of the renderer, submitted by itself.
struct StepSamples {
  Samples milliseconds;      ///< wall clock, recording and submission included
  Samples cpu_milliseconds;  ///< processor time of all threads: on a software device, unlike the clock,
                             ///< it hardly depends on what else the machine does
  std::vector<PassSamples> passes;  ///< in the order of their first dispatch
  double blend_milliseconds = 0;    ///< median of the pass that visits the pixels
};

/// What the renderer takes for one scene.
struct SceneTimes {
  std::string name;
  uint64_t gaussians = 0;
  ImageSize size;
  glsl::RenderStatus status;
  uint64_t pairs = 0;         ///< count_pairs()
  StepSamples forward;        ///< tile lists, and blending of colour, opacity and depth: as in tracking
  StepSamples forward_all;    ///< the same with every output: as in mapping
  StepSamples backward_pose;  ///< gradient of the pose alone
  StepSamples backward;       ///< gradients of all parameters
};

/// Warms up, then measures every step `repeat` times, taking turns.
SceneTimes measure_scene(gpu::Device& device, const TileShape& shape, const BenchScene& scene, int repeat);

/// What a device computes when nothing else is in the way: tells a busy machine from a slow kernel.
struct PeakRates {
  double gflops = 0;  ///< multiply-adds, counted as two operations
  double exponentials_per_ns = 0;
};

/// The best of several measurements.
PeakRates measure_peak(gpu::Device& device);

}  // namespace surefield
