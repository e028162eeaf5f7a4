// surefield bench: how long rendering and its gradients take on fixed scenes.
#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/io/error.h"
#include "engine/io/files.h"
#include "tools/bench_measure.h"
#include "tools/command.h"

namespace surefield {

namespace {

constexpr const char* kHelp =
    "Measures rendering and its gradients, pass by pass, on a room seen from inside.\n"
    "\n"
    "Scenes: small (20 k Gaussians, 160x120), medium (50 k, 320x240), large (150 k, 640x480). A camera is a "
    "JSON\n"
    "object with width, height, fx, fy, cx, cy and world_to_camera (16 numbers, row by row).\n"
    "\n"
    "Examples:\n"
    "  surefield bench --scene medium --json bench.json\n"
    "  surefield bench --map out/desk/map.ply --camera camera.json";

/// What the user asks to measure.
struct BenchOptions {
  std::string scene = "all";
  std::string map, camera, device, tile, json_file;
  int repeat = 15;
};

/// The four steps of a scene with the names that they have in reports.
std::array<std::pair<const char*, const StepSamples*>, 4> steps_of(const SceneTimes& times) {
  return {{{"forward", &times.forward},
           {"forward_all", &times.forward_all},
           {"backward_pose", &times.backward_pose},
           {"backward", &times.backward}}};
}

double ns_per_pair(const SceneTimes& times, const StepSamples& step) {
  return times.pairs ? step.blend_milliseconds * 1e6 / static_cast<double>(times.pairs) : 0;
}

void print(const SceneTimes& times) {
  fmt::print("\n{}: {} Gaussians ({} visible, {} instances), {} x {} pixels, {:.2f} M pairs\n", times.name,
             times.gaussians, times.status.visible, times.status.instances, times.size.width,
             times.size.height, static_cast<double>(times.pairs) * 1e-6);
  fmt::print("  {:<32}{:>10}{:>10}{:>10}{:>12}\n", "", "median ms", "least ms", "CPU ms", "ns a pair");
  for (const auto& [name, step] : steps_of(times)) {
    fmt::print("  {:<32}{:>10.3f}{:>10.3f}{:>10.3f}\n", name, step->milliseconds.median(),
               step->milliseconds.least(), step->cpu_milliseconds.median());
    for (const PassSamples& pass : step->passes) {
      const std::string label =
          pass.dispatches > 1 ? fmt::format("{} x {}", pass.pass, pass.dispatches) : pass.pass;
      fmt::print("    {:<30}{:>10.3f}{:>10.3f}", label, pass.milliseconds.median(),
                 pass.milliseconds.least());
      if (pass.pass.starts_with("blend_")) fmt::print("{:>22.3f}", ns_per_pair(times, *step));
      fmt::print("\n");
    }
  }
}

nlohmann::json to_json(const StepSamples& step, double ns) {
  nlohmann::json passes = nlohmann::json::array();
  for (const PassSamples& pass : step.passes)
    passes.push_back({{"pass", pass.pass},
                      {"dispatches", pass.dispatches},
                      {"ms_median", pass.milliseconds.median()},
                      {"ms_least", pass.milliseconds.least()}});
  return {{"ms_median", step.milliseconds.median()},
          {"ms_least", step.milliseconds.least()},
          {"cpu_ms_median", step.cpu_milliseconds.median()},
          {"cpu_ms_least", step.cpu_milliseconds.least()},
          {"blend_ms_median", step.blend_milliseconds},
          {"ns_per_pair", ns},
          {"passes", passes}};
}

nlohmann::json to_json(const SceneTimes& times) {
  nlohmann::json steps;
  for (const auto& [name, step] : steps_of(times)) steps[name] = to_json(*step, ns_per_pair(times, *step));
  return {{"scene", times.name},
          {"gaussians", times.gaussians},
          {"width", times.size.width},
          {"height", times.size.height},
          {"visible", times.status.visible},
          {"instances", times.status.instances},
          {"pairs", times.pairs},
          {"steps", steps}};
}

/// Whether a subgroup can share out a tile (shaders/lib/tile_pixels.glsl).
bool can_share_out(const TileShape& shape) {
  return std::has_single_bit(shape.width) && std::has_single_bit(shape.height) &&
         shape.width * shape.height >= shape.lanes;
}

/// "16x8", or the device's own shape where `text` is empty.
TileShape tile_shape(const gpu::Device& device, const std::string& text) {
  TileShape shape = TileShape::for_device(device);
  if (text.empty()) return shape;
  char cross = 0;
  std::istringstream in(text);
  if (!(in >> shape.width >> cross >> shape.height) || cross != 'x' || !in.eof() || !can_share_out(shape))
    throw InputError(fmt::format(
        "--tile {}: must be WIDTHxHEIGHT, powers of two that make at least {} pixels", text, shape.lanes));
  return shape;
}

std::vector<BenchScene> scenes_of(gpu::Device& device, const BenchOptions& options) {
  if (!options.map.empty()) return {load_bench_scene(options.map, options.camera)};
  std::vector<BenchScene> scenes;
  for (const std::string& name : bench_scene_names())
    if (options.scene == "all") scenes.push_back(make_bench_scene(device, name));
  if (options.scene != "all") scenes.push_back(make_bench_scene(device, options.scene));
  return scenes;
}

int run(const BenchOptions& options) {
  gpu::Device device({.selector = options.device});
  const TileShape shape = tile_shape(device, options.tile);
  const PeakRates peak = measure_peak(device);
  fmt::print("{}, {}; a subgroup of {} works {} x {} pixels\n", device.report().name, device.report().driver,
             shape.lanes, shape.width, shape.height);
  fmt::print("at best {:.1f} GFLOP/s of multiply-adds, {:.2f} G exponentials/s\n", peak.gflops,
             peak.exponentials_per_ns);
  nlohmann::json scenes = nlohmann::json::array();
  for (const BenchScene& scene : scenes_of(device, options)) {
    const SceneTimes times = measure_scene(device, shape, scene, options.repeat);
    print(times);
    std::fflush(stdout);
    scenes.push_back(to_json(times));
  }
  if (options.json_file.empty()) return kSuccess;
  const nlohmann::json result = {{"device", device.report().name},
                                 {"driver", device.report().driver},
                                 {"subgroup", shape.lanes},
                                 {"tile_width", shape.width},
                                 {"tile_height", shape.height},
                                 {"peak_gflops", peak.gflops},
                                 {"peak_gexp", peak.exponentials_per_ns},
                                 {"repeat", options.repeat},
                                 {"scenes", scenes}};
  write_file(options.json_file, [&](std::ostream& out) { out << result.dump(2) << '\n'; });
  return kSuccess;
}

}  // namespace

void add_bench(CLI::App& program, Action& action) {
  auto options = std::make_shared<BenchOptions>();
  CLI::App* command = program.add_subcommand("bench", kHelp);
  CLI::Option* scene =
      command->add_option("--scene", options->scene, "small, medium, large or all")->capture_default_str();
  CLI::Option* map = command->add_option("--map", options->map, "PLY file of Gaussians to render instead");
  map->excludes(scene)->needs(
      command->add_option("--camera", options->camera, "JSON file: where to see it from"));
  command->add_option("--device", options->device, "index or part of the name, from `surefield devices`");
  command->add_option("--tile", options->tile,
                      "pixels that a subgroup works on, as 16x8; default: the device's own");
  command->add_option("--repeat", options->repeat, "measurements of each step")
      ->capture_default_str()
      ->check(CLI::Range(1, 10000));
  command->add_option("--json", options->json_file, "file to write the results to");
  command->callback([&action, options] { action = [options] { return run(*options); }; });
}

}  // namespace surefield
