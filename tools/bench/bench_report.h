#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/bench/bench_device_use.h"
#include "tools/bench/bench_measure.h"
#include "tools/bench/bench_peak.h"

namespace surefield {

/// What a benchmark ran on.
struct BenchMachine {
  gpu::DeviceReport device;
  TileShape shape;
  PeakRates peak;
};

/// The lines that introduce a benchmark.
std::string describe(const BenchMachine& machine);
/// The tables of one scene.
std::string describe(const BenchMachine& machine, const SceneTimes& times);
/// The table of what a SLAM run asks of the device.
std::string describe(const DeviceUse& use);

/// The same for programs (docs/evaluation.md, "Benchmarks"); `scenes` is there, and empty.
nlohmann::json to_json(const BenchMachine& machine, int repeat);
/// An entry of `scenes`.
nlohmann::json to_json(const SceneTimes& times);
/// The object `slam`.
nlohmann::json to_json(const DeviceUse& use);

}  // namespace surefield
