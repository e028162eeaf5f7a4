#include "tools/bench_measure.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <functional>
#include <map>
#include <string_view>

#include "engine/splat/rasteriser.h"
#include "shaders/shared/measure_peak.h"
#include "tools/pair_count.h"

namespace surefield {

namespace {

constexpr int kWarmUp = 2;

/// Time since it was made.
class Stopwatch {
 public:
  double milliseconds() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }
  double cpu_milliseconds() const {
    return 1e3 * static_cast<double>(std::clock() - cpu_start_) / CLOCKS_PER_SEC;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::clock_t cpu_start_ = std::clock();
};

/// Adds the times of the dispatches of one step.
void add_passes(const std::vector<gpu::PassTime>& times, StepSamples* step) {
  std::map<std::string_view, double> sums;
  for (const gpu::PassTime& time : times) sums[time.pass] += time.milliseconds;
  const bool first = step->passes.empty();
  for (const gpu::PassTime& time : times) {
    auto entry = std::find_if(step->passes.begin(), step->passes.end(),
                              [&](const PassSamples& p) { return p.pass == time.pass; });
    if (entry == step->passes.end()) entry = step->passes.insert(entry, {time.pass});
    if (first) ++entry->dispatches;
  }
  for (PassSamples& pass : step->passes) pass.milliseconds.add(sums[pass.pass]);
}

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

/// A scene on the device.
class SceneBench {
 public:
  SceneBench(gpu::Device& device, const TileShape& shape, const BenchScene& scene)
      : rasteriser_(device, shape),
        map_(device),
        camera_(device, "camera"),
        depth_(device, "sensor depth"),
        recorder_(device),
        size_{static_cast<uint32_t>(scene.camera.intrinsics.width),
              static_cast<uint32_t>(scene.camera.intrinsics.height)} {
    map_.assign(scene.cloud);
    const glsl::CameraState state = to_device(scene.camera);
    camera_.upload(std::span(&state, 1));
    std::vector<float> depth = scene.sensor_depth;
    depth.resize(size_.pixels(), 0.0f);
    depth_.upload(depth);
    do {
      rasteriser_.record_forward(recorder_, map_, view(), Outputs::All);
      recorder_.submit();
    } while (rasteriser_.lists.settle() == 0);
    rasteriser_.pixel_upstream.upload(some_upstream(size_.pixels()));
    recorder_.enable_timestamps();
  }

  void measure(SceneTimes* times) {
    time(&times->forward, [&] { rasteriser_.record_forward(recorder_, map_, view(), Outputs::ColourDepth); });
    time(&times->backward_pose,
         [&] { rasteriser_.record_backward_pose(recorder_, map_, view(), Outputs::ColourDepth); });
    time(&times->forward_all, [&] { rasteriser_.record_forward(recorder_, map_, view(), Outputs::All); });
    time(&times->backward, [&] { rasteriser_.record_backward(recorder_, map_, view(), 0.1f); });
  }

  const TileLists& lists() const { return rasteriser_.lists; }
  const ImageSize& size() const { return size_; }

 private:
  View view() const { return {size_, camera_, depth_}; }

  void time(StepSamples* step, const std::function<void()>& record) {
    const Stopwatch watch;
    record();
    const std::vector<gpu::PassTime> times = recorder_.submit();
    step->milliseconds.add(watch.milliseconds());
    step->cpu_milliseconds.add(watch.cpu_milliseconds());
    add_passes(times, step);
  }

  Rasteriser rasteriser_;
  GaussianMap map_;
  gpu::Array<glsl::CameraState> camera_;
  gpu::Array<float> depth_;
  gpu::Recorder recorder_;
  ImageSize size_;
};

void find_blending(StepSamples* step) {
  for (const PassSamples& pass : step->passes)
    if (pass.pass.starts_with("blend_")) step->blend_milliseconds = pass.milliseconds.median();
}

/// The best rate of one kernel, in operations per nanosecond.
double peak_rate(gpu::Device& device, bool exponentials) {
  constexpr uint32_t kRounds = 4096, kChains = 16, kGroups = 64;
  constexpr int kRepeat = 20;
  const uint32_t lanes = device.limits().subgroup_size;
  const gpu::Pass<passes::measure_peak> pass(device, lanes,
                                             {.EXPONENTIALS = exponentials ? 1u : 0u, .ROUNDS = kRounds});
  gpu::Array<float> results(device, "results", uint64_t{kGroups} * lanes);
  gpu::Recorder recorder(device);
  double best = 0;
  for (int i = 0; i < kRepeat + kWarmUp; ++i) {
    const Stopwatch watch;
    recorder.dispatch(pass, kGroups, {.results = results}, {.factor = 0.999f, .offset = 0.001f});
    recorder.submit();
    best = std::max(best, double{kRounds} * kChains * kGroups * lanes / (1e6 * watch.milliseconds()));
  }
  return best;
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

SceneTimes measure_scene(gpu::Device& device, const TileShape& shape, const BenchScene& scene, int repeat) {
  SceneBench bench(device, shape, scene);
  SceneTimes times;
  for (int i = 0; i < kWarmUp; ++i) bench.measure(&times);
  times = {.name = scene.name, .gaussians = scene.cloud.size(), .size = bench.size()};
  for (int i = 0; i < repeat; ++i) bench.measure(&times);
  for (StepSamples* step : {&times.forward, &times.forward_all, &times.backward_pose, &times.backward})
    find_blending(step);
  times.status = bench.lists().read_status();
  times.pairs = count_pairs(bench.lists(), bench.size());
  return times;
}

PeakRates measure_peak(gpu::Device& device) {
  return {.gflops = 2 * peak_rate(device, false), .exponentials_per_ns = peak_rate(device, true)};
}

}  // namespace surefield
