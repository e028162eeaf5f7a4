#pragma once

#include <string>
#include <vector>

#include "engine/gpu/device.h"
#include "tools/bench/bench_scenes.h"
#include "tools/bench/host_tile_lists.h"

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

/// How long something takes as a whole.
struct Times {
  Samples milliseconds;      ///< wall clock
  Samples cpu_milliseconds;  ///< processor time of all threads: on a software device, unlike the clock, it
                             ///< hardly depends on what else the machine does
};

/// Device time of all dispatches of one pass within one step.
struct PassSamples {
  std::string pass;
  double dispatches = 0;  ///< a step
  Samples milliseconds;   ///< their sum
};

/// One step of the engine, recording, submission and everything on the host included. Passes are timed in
/// submissions of their own, since time stamps slow a device down.
struct StepTimes {
  std::string name;
  Times whole;
  std::vector<PassSamples> passes;  ///< in the order of their first dispatch
  double passes_milliseconds() const;
  /// Median of the pass of that name; 0 where there is none.
  double pass_milliseconds(const std::string& pass) const;
};

/// CpuBlender over the tile lists of `forward`.
struct LoopTimes {
  std::string instructions;
  Times whole;
  double colour_difference = 0;  ///< mean, from the device's image
};

/// What a scene takes. The steps are, in this order:
///   forward         tile lists, and blending of colour, opacity and depth: as in tracking
///   forward_all     the same with every output: as in mapping
///   forward_pose    forward, and backward to the pose alone
///   forward_full    forward_all, and backward to every parameter
///   mapping         a step of mapping: forward_all, losses, backward, Adam
///   tracking_adam   a step of the Adam tracker
///   tracking_gauss_newton  a whole frame of the Gauss-Newton tracker
struct SceneTimes {
  std::string name;
  uint64_t gaussians = 0;
  ImageSize size;
  glsl::RenderStatus status;
  PairCount pairs;  ///< of one render
  std::vector<StepTimes> steps;
  std::vector<LoopTimes> loops;  ///< of each of cpu_kernels()
  uint64_t device_bytes = 0;     ///< in use at the end of the steps

  const StepTimes& step(const std::string& name) const;
};

/// Warms up, then measures every step `repeat` times, taking turns.
SceneTimes measure_scene(gpu::Device& device, const TileShape& shape, const BenchScene& scene, int repeat);

}  // namespace surefield
