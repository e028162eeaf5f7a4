#include "tools/bench/bench_compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "engine/io/json_file.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

struct Figure {
  std::string name;
  double value = 0;
};

/// A heading with its figures.
struct Section {
  std::string title;
  std::vector<Figure> figures;
};

struct Benchmark {
  std::string machine;
  std::vector<Section> sections;
};

/// Times in milliseconds under the names that the tables of a benchmark have.
void add_steps(const nlohmann::json& steps, Section* section) {
  for (const auto& [name, step] : steps.items()) {
    section->figures.push_back({name, step.at("ms_median").get<double>()});
    section->figures.push_back({name + ", CPU", step.at("cpu_ms_median").get<double>()});
    if (!step.contains("passes")) continue;
    for (const nlohmann::json& pass : step.at("passes"))
      section->figures.push_back(
          {fmt::format("  {}: {}", name, pass.at("pass").get<std::string>()), pass.at("ms_median")});
  }
}

Section read_scene(const nlohmann::json& scene) {
  Section section{.title = fmt::format("{}, ms", scene.at("scene").get<std::string>()), .figures = {}};
  for (const nlohmann::json& loop : scene.at("cpp_loops"))
    section.figures.push_back(
        {"C++ loop, " + loop.at("instructions").get<std::string>(), loop.at("ms_median").get<double>()});
  add_steps(scene.at("steps"), &section);
  for (const char* count : {"instances", "pairs", "pairs_blended", "device_bytes"})
    section.figures.push_back({count, scene.at(count).get<double>()});
  return section;
}

/// What frames of the SLAM run ask of the device, on average.
Section read_slam(const nlohmann::json& slam) {
  Section section{.title = "slam, a frame", .figures = {}};
  for (const char* kind : {"tracked", "keyframes"})
    for (const char* figure : {"submissions", "allocations", "objects", "bytes_uploaded", "bytes_read_back"})
      section.figures.push_back({fmt::format("{}: {}", kind, figure), slam.at(kind).at(figure).at("mean")});
  return section;
}

Benchmark read_benchmark(const std::filesystem::path& file) {
  const JsonObject json(file);
  try {
    if (json.at("schema") != "surefield-bench") json.fail("schema", "must be \"surefield-bench\"");
    const nlohmann::json& device = json.at("device");
    Benchmark benchmark{.machine = fmt::format("{}, {}, commit {}", device.at("name").get<std::string>(),
                                               device.at("driver").get<std::string>(),
                                               json.at("program").at("commit").get<std::string>()),
                        .sections = {{.title = "peak", .figures = {}}}};
    for (const auto& [name, value] : json.at("peak").items())
      benchmark.sections[0].figures.push_back({name, value.get<double>()});
    if (json.has("slam")) benchmark.sections.push_back(read_slam(json.at("slam")));
    for (const nlohmann::json& scene : json.at("scenes")) benchmark.sections.push_back(read_scene(scene));
    return benchmark;
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file, std::string("is no result of `surefield bench --json`: ") + error.what());
  }
}

/// The figures that both have, in the order of the first.
std::string compare(const Section& first, const Section& second) {
  std::string text = fmt::format("\n{:<44}{:>14}{:>14}{:>9}\n", first.title, "first", "second", "ratio");
  for (const Figure& a : first.figures) {
    const auto b = std::find_if(second.figures.begin(), second.figures.end(),
                                [&](const Figure& figure) { return figure.name == a.name; });
    if (b == second.figures.end()) continue;
    const std::string ratio = a.value > 0 ? fmt::format("{:.3f}", b->value / a.value) : "-";
    text += fmt::format("  {:<42}{:>14.6g}{:>14.6g}{:>9}\n", a.name, a.value, b->value, ratio);
  }
  return text;
}

}  // namespace

std::string compare_benchmarks(const std::filesystem::path& first, const std::filesystem::path& second) {
  const Benchmark a = read_benchmark(first), b = read_benchmark(second);
  std::string text =
      fmt::format("first   {}: {}\nsecond  {}: {}\n", first.string(), a.machine, second.string(), b.machine);
  std::size_t shared = 0;
  for (const Section& section : a.sections)
    for (const Section& other : b.sections) {
      if (section.title != other.title) continue;
      text += compare(section, other);
      ++shared;
    }
  if (shared < 2)
    throw InputError(second,
                     "has no scene in common with " + first.string() + ": measure the same --scene for both");
  return text;
}

}  // namespace surefield
