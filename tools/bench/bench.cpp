// surefield bench: how long rendering and its gradients take on fixed scenes, and what frames ask of the
// device.
#include <fmt/format.h>

#include <bit>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/io/files.h"
#include "engine/types/error.h"
#include "tools/bench/bench_compare.h"
#include "tools/bench/bench_device_use.h"
#include "tools/bench/bench_report.h"
#include "tools/bench/cpu_blend.h"
#include "tools/shared/command.h"

namespace surefield {

namespace {

constexpr const char* kHelp =
    "Measures rendering, gradients, mapping and tracking, pass by pass and as a whole, on a room seen from\n"
    "inside; beside it the same blending in plain C++ on all cores, and what the device can do at best.\n"
    "\n"
    "Scenes: small (20 k Gaussians, 160x120), medium (50 k, 320x240), large (150 k, 640x480), huge (800 k,\n"
    "1200x680); slam: a short run of SLAM, of which is counted what frames ask of the device. A camera is a "
    "JSON object with width, height, fx, fy, cx, cy and world_to_camera (16 "
    "numbers,\n"
    "row by row). docs/evaluation.md says what the figures mean.\n"
    "\n"
    "Examples:\n"
    "  surefield bench --scene medium --json bench.json\n"
    "  surefield bench --map out/desk/map.ply --camera camera.json\n"
    "  surefield bench --compare before.json after.json";

constexpr const char* kSlam = "slam";  // among the names of scenes

/// What the user asks to measure.
struct BenchOptions {
  std::string scene = "all";
  std::string map, camera, device, tile, json_file;
  std::vector<std::string> compared;
  int repeat = 15;
};

/// Whether a subgroup can share out a tile (shaders/lib/tile_pixels.glsl).
bool can_share_out(const TileShape& shape) {
  return std::has_single_bit(shape.width) && std::has_single_bit(shape.height) &&
         shape.width * shape.height >= shape.lanes && shape.width * shape.height <= CpuBlender::kMostPixels;
}

/// "16x8", or the device's own shape where `text` is empty.
TileShape tile_shape(const gpu::Device& device, const std::string& text) {
  TileShape shape = TileShape::for_device(device);
  if (text.empty()) return shape;
  char cross = 0;
  std::istringstream in(text);
  if (!(in >> shape.width >> cross >> shape.height) || cross != 'x' || !in.eof() || !can_share_out(shape))
    throw InputError(fmt::format("--tile {}: must be WIDTHxHEIGHT, powers of two that make {} to {} pixels",
                                 text, shape.lanes, CpuBlender::kMostPixels));
  return shape;
}

/// Whether the device use of a SLAM run is counted.
bool counts_slam(const BenchOptions& options) {
  return options.map.empty() && (options.scene == "all" || options.scene == kSlam);
}

/// The scenes to measure; a map from a file is one without a name.
std::vector<std::string> names_of(const BenchOptions& options) {
  if (!options.map.empty()) return {""};
  if (options.scene == "all") return bench_scene_names();
  if (options.scene == kSlam) return {};
  return {options.scene};
}

BenchScene make_scene(gpu::Device& device, const BenchOptions& options, const std::string& name) {
  return name.empty() ? load_bench_scene(options.map, options.camera) : make_bench_scene(device, name);
}

int run(const BenchOptions& options) {
  if (!options.compared.empty()) {
    fmt::print("{}", compare_benchmarks(options.compared[0], options.compared[1]));
    return kSuccess;
  }
  gpu::Device device({.selector = options.device});
  const TileShape shape = tile_shape(device, options.tile);
  const BenchMachine machine{device.report(), shape, measure_peak(device)};
  fmt::print("{}", describe(machine));
  nlohmann::json results = to_json(machine, options.repeat);
  // After every part, so that an interruption costs one part only.
  const auto save = [&] {
    std::fflush(stdout);
    if (!options.json_file.empty())
      write_file(options.json_file, [&](std::ostream& out) { out << results.dump(2) << '\n'; });
  };
  if (counts_slam(options)) {
    const DeviceUse use = measure_device_use(options.device);
    fmt::print("{}", describe(use));
    results["slam"] = to_json(use);
    save();
  }
  for (const std::string& name : names_of(options)) {
    const SceneTimes times = measure_scene(device, shape, make_scene(device, options, name), options.repeat);
    fmt::print("{}", describe(machine, times));
    results["scenes"].push_back(to_json(times));
    save();
  }
  return kSuccess;
}

}  // namespace

void add_bench(CLI::App& program, Action& action) {
  auto options = std::make_shared<BenchOptions>();
  CLI::App* command = program.add_subcommand("bench", kHelp);
  CLI::Option* scene =
      command->add_option("--scene", options->scene, "small, medium, large, huge, slam or all")
          ->capture_default_str();
  CLI::Option* map = command->add_option("--map", options->map, "Gaussians to render instead, PLY or SPZ");
  map->excludes(scene)->needs(
      command->add_option("--camera", options->camera, "JSON file: where to see it from"));
  command->add_option("--device", options->device, "index or part of the name, from `surefield devices`");
  command->add_option("--tile", options->tile,
                      "pixels that a subgroup works on, as 16x8; default: the device's own");
  command->add_option("--repeat", options->repeat, "measurements of each step")
      ->capture_default_str()
      ->check(CLI::Range(1, 10000));
  command->add_option("--json", options->json_file, "file to write the results to");
  command
      ->add_option("--compare", options->compared, "two such files: prints the second's ratios to the first")
      ->expected(2)
      ->type_name("FILE FILE");
  command->callback([&action, options] { action = [options] { return run(*options); }; });
}

}  // namespace surefield
