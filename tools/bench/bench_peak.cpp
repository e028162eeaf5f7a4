#include "tools/bench/bench_peak.h"

#include <algorithm>
#include <chrono>
#include <functional>

#include "engine/gpu/recorder.h"
#include "shaders/shared/measure_peak.h"

namespace surefield {

namespace {

constexpr int kRepeat = 12;
// Beyond every cache, but within what a device binds at once.
constexpr uint64_t kCopied = 64 << 20;

/// Seconds that the fastest of several submissions takes.
double least_seconds(gpu::Recorder& recorder, const std::function<void()>& record) {
  double best = 0;
  for (int i = 0; i < kRepeat; ++i) {
    record();
    const auto start = std::chrono::steady_clock::now();
    recorder.submit();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    best = i == 0 ? seconds : std::min(best, seconds);
  }
  return best;
}

/// The rate of the kernel that computes, in operations per nanosecond.
double compute_rate(gpu::Device& device, uint32_t measure) {
  constexpr uint32_t kRounds = 512, kWorkgroup = 64;
  // A software device needs few workgroups for all its cores, a GPU many.
  const uint32_t groups = device.limits().is_cpu ? 64 : 16384;
  const gpu::Pass<passes::measure_peak> pass(device, kWorkgroup, {.MEASURE = measure, .ROUNDS = kRounds});
  const gpu::Array<glsl::vec4> source(device, "source"), results(device, "results", groups * kWorkgroup);
  gpu::Recorder recorder(device);
  const double seconds = least_seconds(recorder, [&] {
    recorder.dispatch(pass, groups, {.source = source, .results = results},
                      {.factor = 0.999f, .offset = 0.001f});
  });
  return double{kRounds} * glsl::PEAK_UNROLLED * glsl::PEAK_CHAINS * groups * kWorkgroup / (1e9 * seconds);
}

/// What copying from one buffer to another reaches, in bytes per nanosecond.
void copy_rates(gpu::Device& device, PeakRates* rates) {
  constexpr uint32_t kWorkgroup = 256;
  constexpr uint64_t kEntries = kCopied / sizeof(glsl::vec4);
  const gpu::Pass<passes::measure_peak> pass(device, kWorkgroup, {.MEASURE = glsl::PEAK_COPY});
  const gpu::Array<glsl::vec4> source(device, "source", kEntries), results(device, "results", kEntries);
  gpu::Recorder recorder(device);
  recorder.fill(source, kEntries, 1);
  recorder.submit();
  const auto rate = [&](const std::function<void()>& record) {
    return static_cast<double>(kCopied) / (1e9 * least_seconds(recorder, record));
  };
  rates->copy_gb_per_s = rate([&] {
    recorder.copy({&source.buffer(), 0, kCopied}, {&results.buffer(), 0, kCopied});
  });
  rates->kernel_copy_gb_per_s = rate(
      [&] { recorder.dispatch(pass, kEntries / kWorkgroup, {.source = source, .results = results}, {}); });
}

}  // namespace

PeakRates measure_peak(gpu::Device& device) {
  PeakRates rates{.gflops = 2 * compute_rate(device, glsl::PEAK_MULTIPLY_ADDS),
                  .exponentials_per_ns = compute_rate(device, glsl::PEAK_EXPONENTIALS)};
  copy_rates(device, &rates);
  return rates;
}

}  // namespace surefield
