#include "tools/bench/bench_measure.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string_view>

#include "tools/bench/bench_steps.h"
#include "tools/bench/cpu_blend.h"
#include "tools/shared/progress_line.h"

namespace surefield {

namespace {

constexpr int kWarmUp = 2;
constexpr int kTimedRuns = 3;  // of every pass measurement, so many runs without time stamps

/// Adds how long `work` takes, divided by `units`.
void time(const std::function<void()>& work, int units, Times* times) {
  const std::clock_t cpu_start = std::clock();
  const auto start = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start;
  times->milliseconds.add(wall.count() / units);
  times->cpu_milliseconds.add(1e3 * static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC / units);
}

/// Adds the times of the dispatches of `units` steps.
void add_passes(const std::vector<gpu::PassTime>& times, int units, StepTimes* step) {
  std::map<std::string_view, std::pair<int, double>> sums;
  for (const gpu::PassTime& time : times) {
    ++sums[time.pass].first;
    sums[time.pass].second += time.milliseconds;
    const auto is_pass = [&](const PassSamples& p) { return p.pass == time.pass; };
    if (std::none_of(step->passes.begin(), step->passes.end(), is_pass)) step->passes.push_back({time.pass});
  }
  for (PassSamples& pass : step->passes) {
    const auto& [dispatches, milliseconds] = sums[pass.pass];
    pass.dispatches = static_cast<double>(dispatches) / units;
    pass.milliseconds.add(milliseconds / units);
  }
}

/// Measures one step once: as a whole, and pass by pass every few times.
void measure(gpu::Device& device, const BenchStep& step, int round, StepTimes* times) {
  step.prepare();
  time(step.run, step.units, &times->whole);
  if (round % kTimedRuns != 0) return;
  step.prepare();
  device.time_passes(true);
  step.run();
  device.time_passes(false);
  add_passes(device.take_pass_times(), step.units, times);
}

/// The mean difference of the colours.
double difference(const std::vector<glsl::vec4>& device, const CpuImages& host) {
  double sum = 0;
  for (std::size_t i = 0; i < device.size(); ++i)
    sum += std::abs(device[i].x - host.red[i]) + std::abs(device[i].y - host.green[i]) +
           std::abs(device[i].z - host.blue[i]);
  return sum / static_cast<double>(3 * device.size());
}

}  // namespace

double Samples::median() const {
  std::vector<double> sorted = values_;
  std::sort(sorted.begin(), sorted.end());
  return sorted.empty() ? 0 : sorted[sorted.size() / 2];
}

double Samples::least() const {
  return values_.empty() ? 0 : *std::min_element(values_.begin(), values_.end());
}

double StepTimes::passes_milliseconds() const {
  return std::accumulate(passes.begin(), passes.end(), 0.0, [](double sum, const PassSamples& pass) {
    return sum + pass.milliseconds.median();
  });
}

double StepTimes::pass_milliseconds(const std::string& wanted) const {
  for (const PassSamples& pass : passes)
    if (pass.pass == wanted) return pass.milliseconds.median();
  return 0;
}

const StepTimes& SceneTimes::step(const std::string& wanted) const {
  for (const StepTimes& step : steps)
    if (step.name == wanted) return step;
  throw std::out_of_range("no step " + wanted);
}

SceneTimes measure_scene(gpu::Device& device, const TileShape& shape, const BenchScene& scene, int repeat) {
  SceneSteps bench(device, shape, scene);
  SceneTimes times{.name = scene.name, .gaussians = scene.cloud.size(), .size = bench.size()};
  bench.render();
  const TileLists& lists = bench.rasteriser().lists;
  times.status = lists.read_status();
  const HostTileLists host = download(lists, bench.size());
  times.pairs = count_pairs(host);
  CpuBlender cpu(host);
  const auto image = bench.rasteriser().colour_opacity.download(bench.size().pixels());
  const std::vector<CpuKernel> kernels = cpu_kernels();
  for (const CpuKernel& kernel : kernels)
    times.loops.push_back(
        {.instructions = kernel.instructions, .colour_difference = difference(image, cpu.blend(kernel))});

  const std::vector<BenchStep> steps = bench.steps();
  for (const BenchStep& step : steps) times.steps.push_back({.name = step.name});
  ProgressLine progress(scene.name);
  for (int round = -kWarmUp; round < repeat; ++round) {
    for (std::size_t i = 0; i < steps.size(); ++i) {
      StepTimes warming;
      measure(device, steps[i], round, round < 0 ? &warming : &times.steps[i]);
      progress.show(static_cast<double>(round + kWarmUp) / (repeat + kWarmUp), steps[i].name);
    }
    for (std::size_t i = 0; i < kernels.size(); ++i) {
      Times warming;
      time([&] { cpu.blend(kernels[i]); }, 1, round < 0 ? &warming : &times.loops[i].whole);
    }
  }
  times.device_bytes = device.memory_in_use();
  return times;
}

}  // namespace surefield
