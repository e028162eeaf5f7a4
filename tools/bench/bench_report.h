#pragma once

#include <nlohmann/json.hpp>
#include <string>

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

/// The same for programs (docs/evaluation.md, "Benchmarks"); `scenes` from to_json() of each scene.
nlohmann::json to_json(const BenchMachine& machine, int repeat, const nlohmann::json& scenes);
nlohmann::json to_json(const SceneTimes& times);

}  // namespace surefield
