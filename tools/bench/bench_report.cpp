#include "tools/bench/bench_report.h"

#include <fmt/format.h>

#include "engine/types/build_info.h"
#include "engine/types/version.h"
#include "tools/bench/cpu_blend.h"

namespace surefield {

namespace {

double ratio(double a, double b) {
  return b > 0 ? a / b : 0;
}

double ns_per_pair(const SceneTimes& times, double milliseconds) {
  return ratio(1e6 * milliseconds, static_cast<double>(times.pairs.processed));
}

/// A pass that visits every pair of a view.
bool is_blending(const std::string& pass) {
  return pass.starts_with("blend_");
}

/// How much slower than the loop in C++ the device is, by what is compared.
struct LoopRatios {
  double blending;     ///< blend_forward's device time
  double forward;      ///< the whole of `forward`, tile lists and all
  double forward_cpu;  ///< the same in processor time; means little for a GPU
};

LoopRatios loop_ratios(const SceneTimes& times, const LoopTimes& loop) {
  const StepTimes& forward = times.step("forward");
  const double milliseconds = loop.whole.milliseconds.median();
  return {
      .blending = ratio(forward.pass_milliseconds("blend_forward"), milliseconds),
      .forward = ratio(forward.whole.milliseconds.median(), milliseconds),
      .forward_cpu = ratio(forward.whole.cpu_milliseconds.median(), loop.whole.cpu_milliseconds.median())};
}

/// A name of something that is timed as a whole, and its times.
std::string whole_line(const std::string& name, const Times& times) {
  return fmt::format("  {:<32}{:>10.3f}{:>10.3f}{:>10.3f}", name, times.milliseconds.median(),
                     times.milliseconds.least(), times.cpu_milliseconds.median());
}

/// What a pair takes: nanoseconds, and the multiply-adds that the device could have done in that time.
std::string pair_columns(const BenchMachine& machine, double ns) {
  return fmt::format("{:>11.3f}{:>11.1f}", ns, 0.5 * machine.peak.gflops * ns);
}

std::string step_lines(const BenchMachine& machine, const SceneTimes& times, const StepTimes& step) {
  std::string text = whole_line(step.name, step.whole) + "\n";
  const double sum = step.passes_milliseconds();
  for (const PassSamples& pass : step.passes) {
    const double milliseconds = pass.milliseconds.median();
    const std::string label =
        pass.dispatches > 1 ? fmt::format("{} x {:.3g}", pass.pass, pass.dispatches) : pass.pass;
    text += fmt::format("    {:<30}{:>10.3f}{:>10.3f}{:>10}{:>7.1f} %", label, milliseconds,
                        pass.milliseconds.least(), "", 100 * ratio(milliseconds, sum));
    if (is_blending(pass.pass))
      text += pair_columns(machine, ns_per_pair(times, milliseconds / pass.dispatches));
    text += "\n";
  }
  return text;
}

/// A figure of DeviceCounters.
struct UseFigure {
  const char* name;
  uint64_t gpu::DeviceCounters::*figure;
};
constexpr UseFigure kUseFigures[] = {{"submissions", &gpu::DeviceCounters::submissions},
                                     {"allocations", &gpu::DeviceCounters::allocations},
                                     {"objects", &gpu::DeviceCounters::objects},
                                     {"bytes_uploaded", &gpu::DeviceCounters::bytes_uploaded},
                                     {"bytes_read_back", &gpu::DeviceCounters::bytes_read_back}};

double mean(const FrameUse& use, const UseFigure& figure) {
  return ratio(static_cast<double>(use.total.*figure.figure), use.frames);
}

std::string use_lines(const char* kind, const FrameUse& use) {
  std::string means = fmt::format("  {:<32}", fmt::format("{}, mean of {}", kind, use.frames));
  std::string most = fmt::format("  {:<32}", "  at most");
  for (const UseFigure& figure : kUseFigures) {
    means += fmt::format("{:>17.1f}", mean(use, figure));
    most += fmt::format("{:>17}", use.most.*figure.figure);
  }
  return means + "\n" + most + "\n";
}

nlohmann::json to_json(const FrameUse& use) {
  nlohmann::json result = {{"frames", use.frames}};
  for (const UseFigure& figure : kUseFigures)
    result[figure.name] = {{"mean", mean(use, figure)}, {"most", use.most.*figure.figure}};
  return result;
}

nlohmann::json to_json(const Times& times) {
  return {{"ms_median", times.milliseconds.median()},
          {"ms_least", times.milliseconds.least()},
          {"cpu_ms_median", times.cpu_milliseconds.median()},
          {"cpu_ms_least", times.cpu_milliseconds.least()}};
}

nlohmann::json to_json(const SceneTimes& times, const StepTimes& step) {
  nlohmann::json result = to_json(step.whole);
  const double sum = step.passes_milliseconds();
  result["passes_ms_median"] = sum;
  for (const PassSamples& pass : step.passes) {
    const double milliseconds = pass.milliseconds.median();
    nlohmann::json entry = {{"pass", pass.pass},
                            {"dispatches", pass.dispatches},
                            {"ms_median", milliseconds},
                            {"ms_least", pass.milliseconds.least()},
                            {"share", ratio(milliseconds, sum)}};
    if (is_blending(pass.pass)) entry["ns_per_pair"] = ns_per_pair(times, milliseconds / pass.dispatches);
    result["passes"].push_back(entry);
  }
  return result;
}

nlohmann::json to_json(const SceneTimes& times, const LoopTimes& loop) {
  nlohmann::json result = to_json(loop.whole);
  const LoopRatios ratios = loop_ratios(times, loop);
  result["instructions"] = loop.instructions;
  result["threads"] = CpuBlender::threads();
  result["ns_per_pair"] = ns_per_pair(times, loop.whole.milliseconds.median());
  result["blend_forward_ratio"] = ratios.blending;
  result["forward_ratio"] = ratios.forward;
  result["forward_cpu_ratio"] = ratios.forward_cpu;
  result["mean_colour_difference"] = loop.colour_difference;
  return result;
}

}  // namespace

std::string describe(const BenchMachine& machine) {
  return fmt::format(
      "{}, {}; a subgroup of {} works {} x {} pixels\n"
      "at best {:.1f} GFLOP/s of multiply-adds, {:.2f} G exponentials/s; copies {:.1f} GB/s, by a kernel "
      "{:.1f} GB/s\n",
      machine.device.name, machine.device.driver, machine.shape.lanes, machine.shape.width,
      machine.shape.height, machine.peak.gflops, machine.peak.exponentials_per_ns, machine.peak.copy_gb_per_s,
      machine.peak.kernel_copy_gb_per_s);
}

std::string describe(const BenchMachine& machine, const SceneTimes& times) {
  std::string text = fmt::format(
      "\n{}: {} Gaussians ({} visible, {} instances), {} x {} pixels\n"
      "{:.2f} M pairs, of which {:.2f} M change a pixel; {:.1f} MB on the device\n"
      "  {:<32}{:>10}{:>10}{:>10}{:>9}{:>11}{:>11}\n",
      times.name, times.gaussians, times.status.visible, times.status.instances, times.size.width,
      times.size.height, static_cast<double>(times.pairs.processed) * 1e-6,
      static_cast<double>(times.pairs.blended) * 1e-6, static_cast<double>(times.device_bytes) * 1e-6, "",
      "median ms", "least ms", "CPU ms", "share", "ns a pair", "mul-adds");
  for (const LoopTimes& loop : times.loops)
    text += whole_line(fmt::format("C++ loop, {}, {} threads", loop.instructions, CpuBlender::threads()),
                       loop.whole) +
            fmt::format("{:>9}", "") +
            pair_columns(machine, ns_per_pair(times, loop.whole.milliseconds.median())) + "\n";
  for (const StepTimes& step : times.steps) text += step_lines(machine, times, step);
  for (const LoopTimes& loop : times.loops) {
    const LoopRatios ratios = loop_ratios(times, loop);
    text += fmt::format(
        "  against the C++ loop with {}: blend_forward {:.2f}, all of forward {:.2f}, by CPU time {:.2f}\n",
        loop.instructions, ratios.blending, ratios.forward, ratios.forward_cpu);
  }
  return text;
}

std::string describe(const DeviceUse& use) {
  std::string text =
      fmt::format("\n{:<34}", fmt::format("slam: {} frames, {} x {}", use.frames, use.width, use.height));
  for (const UseFigure& figure : kUseFigures) text += fmt::format("{:>17}", figure.name);
  return text + "\n" + use_lines("tracked frame", use.tracked) + use_lines("keyframe", use.keyframes);
}

nlohmann::json to_json(const BenchMachine& machine, int repeat) {
  return {
      {"schema", "surefield-bench"},
      {"version", 1},
      {"program", {{"version", kVersion}, {"commit", kGitCommit}}},
      {"device", {{"name", machine.device.name}, {"driver", machine.device.driver}}},
      {"tiles",
       {{"lanes", machine.shape.lanes}, {"width", machine.shape.width}, {"height", machine.shape.height}}},
      {"peak",
       {{"gflops", machine.peak.gflops},
        {"gexp_per_s", machine.peak.exponentials_per_ns},
        {"copy_gb_per_s", machine.peak.copy_gb_per_s},
        {"kernel_copy_gb_per_s", machine.peak.kernel_copy_gb_per_s}}},
      {"repeat", repeat},
      {"scenes", nlohmann::json::array()}};
}

nlohmann::json to_json(const SceneTimes& times) {
  nlohmann::json steps;
  for (const StepTimes& step : times.steps) steps[step.name] = to_json(times, step);
  nlohmann::json loops = nlohmann::json::array();
  for (const LoopTimes& loop : times.loops) loops.push_back(to_json(times, loop));
  return {{"scene", times.name},
          {"gaussians", times.gaussians},
          {"width", times.size.width},
          {"height", times.size.height},
          {"visible", times.status.visible},
          {"instances", times.status.instances},
          {"pairs", times.pairs.processed},
          {"pairs_blended", times.pairs.blended},
          {"device_bytes", times.device_bytes},
          {"cpp_loops", loops},
          {"steps", steps}};
}

nlohmann::json to_json(const DeviceUse& use) {
  return {{"frames", use.frames},
          {"width", use.width},
          {"height", use.height},
          {"tracked", to_json(use.tracked)},
          {"keyframes", to_json(use.keyframes)}};
}

}  // namespace surefield
