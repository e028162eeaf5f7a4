// surefield bench: the figures that do not depend on the clock.
#include <algorithm>
#include <cmath>

#include "engine/formats/ply.h"
#include "engine/splat/rasteriser.h"
#include "tests/support/device.h"
#include "tests/tools/support.h"
#include "tools/bench/cpu_blend.h"

using namespace surefield;
using namespace surefield::test;

namespace {

constexpr const char* kCamera = R"({"width": 50, "height": 37, "fx": 40, "fy": 40, "cx": 24.5, "cy": 18,
  "world_to_camera": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]})";

/// Layers of Gaussians of many sizes, shapes, colours and opacities, in front of kCamera.
GaussianCloud layers() {
  constexpr std::size_t kCount = 900;
  GaussianCloud cloud;
  cloud.resize(kCount);
  cloud.sh.assign(3 * kCount, 0);
  for (std::size_t i = 0; i < kCount; ++i) {
    const double t = static_cast<double>(i), z = 1.5 + 0.002 * t;
    cloud.means[i] = {static_cast<float>(z * 0.7 * std::sin(2.3 * t)),
                      static_cast<float>(z * 0.5 * std::sin(1.7 * t + 1)), static_cast<float>(z)};
    for (int axis = 0; axis < 3; ++axis)
      cloud.log_scales[i][axis] = static_cast<float>(-3.2 + std::sin(t * (axis + 1)));
    cloud.rotations[i] = {1, static_cast<float>(std::sin(t)), static_cast<float>(std::cos(t)), 0.3f};
    cloud.opacity_logits[i] = static_cast<float>(3 * std::sin(0.9 * t));
    for (std::size_t c = 0; c < 3; ++c)
      cloud.sh[3 * i + c] = static_cast<float>(std::sin(0.8 * t + static_cast<double>(c)));
  }
  return cloud;
}

Camera camera() {
  return {{.width = 50, .height = 37, .fx = 40, .fy = 40, .cx = 24.5, .cy = 18}};
}

double largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
  REQUIRE(a.size() == b.size());
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max<double>(largest, std::abs(a[i] - b[i]));
  return largest;
}

/// A tile of 8 x 8 pixels and a list of Gaussians that all cover it evenly.
HostTileLists even_tile(const std::vector<float>& opacities, const ImageSize& size) {
  HostTileLists lists{.shape = {8, 8, 4}, .size = size, .tiles_x = 1, .tiles_y = 1};
  lists.ranges = {{0, static_cast<uint32_t>(opacities.size())}};
  for (uint32_t i = 0; i < opacities.size(); ++i) {
    lists.gaussians.push_back(i);
    lists.splats.push_back({.conic = {0, 0, 0}, .opacity = opacities[i], .colour = {1, 0.5f, 0}, .depth = 2});
  }
  return lists;
}

std::vector<std::string> tiny_bench(const TemporaryFolder& folder, const std::string& json) {
  write_ply(folder / "map.ply", layers());
  return {"bench",  "--map",       folder / "map.ply", "--camera", folder.write("camera.json", kCamera),
          "--json", folder / json, "--repeat",         "1"};
}

}  // namespace

TEST_CASE("plain C++ blends the tile lists into the image that the device renders, whatever the tile") {
  gpu::Device& device = testing::device();
  const uint32_t lanes = device.limits().subgroup_size;
  GaussianMap map(device);
  map.assign(layers());
  for (const TileShape& shape : {TileShape{8, 8, lanes}, TileShape{16, 4, lanes}, TileShape{16, 16, lanes}}) {
    Rasteriser rasteriser(device, shape);
    const RenderImages images = rasteriser.render(map, camera());
    CpuBlender blender(download(rasteriser.lists, {50, 37}));
    for (const CpuKernel& kernel : cpu_kernels()) {
      CAPTURE(kernel.instructions);
      const CpuImages& plain = blender.blend(kernel);
      // Rounding may decide whether a contribution just counts, of at most 1/255.
      CHECK(largest_difference(plain.opacity, images.opacity) < 0.004);
      CHECK(largest_difference(plain.depth, images.depth) < 0.015);
      double sum = 0;
      for (std::size_t i = 0; i < plain.red.size(); ++i)
        for (const auto& [value, c] :
             {std::pair{plain.red[i], 0u}, std::pair{plain.green[i], 1u}, std::pair{plain.blue[i], 2u}})
          sum += std::abs(value - images.colour[3 * i + c]);
      CHECK(sum / static_cast<double>(3 * plain.red.size()) < 2e-6);
    }
    CHECK(*std::max_element(images.opacity.begin(), images.opacity.end()) > 0.999f);
    CHECK(*std::min_element(images.opacity.begin(), images.opacity.end()) < 0.9f);
  }
}

TEST_CASE("pairs are counted up to the batch after which every pixel has stopped") {
  const ImageSize whole{8, 8}, part{5, 3};
  CHECK(count_pairs(even_tile({}, whole)).processed == 0);
  const PairCount open = count_pairs(even_tile({0.5f, 0.5f, 0.5f, 0.001f, 0.5f}, whole));
  CHECK(open.processed == 5 * 64);
  CHECK(open.blended == 4 * 64);  // one is too faint
  // 0.01 of the light is left after one, 1e-4 after two, and a third would leave too little.
  const PairCount closed = count_pairs(even_tile(std::vector<float>(20, 0.985f), whole));
  CHECK(closed.processed == 4 * 64);
  CHECK(closed.blended == 2 * 64);
  CHECK(count_pairs(even_tile({0.5f}, part)).processed == 64);
  CHECK(count_pairs(even_tile({0.5f}, part)).blended == 15);
}

TEST_CASE("bench measures every step of a map from a file") {
  const TemporaryFolder folder;
  const Outcome outcome = surefield_command(tiny_bench(folder, "bench.json"), folder.path());
  CHECK_MESSAGE(outcome.code == 0, outcome.err);
  const auto json = read_json(folder / "bench.json");
  CHECK(json["schema"] == "surefield-bench");
  for (const char* rate : {"gflops", "gexp_per_s", "copy_gb_per_s", "kernel_copy_gb_per_s"})
    CHECK(json["peak"][rate] > 0);
  REQUIRE(json["scenes"].size() == 1);
  const auto& scene = json["scenes"][0];
  CHECK(scene["gaussians"] == 900);
  CHECK(scene["instances"] > 900);
  CHECK(scene["pairs"] > scene["pairs_blended"]);
  CHECK(scene["pairs_blended"] > 50 * 37);
  CHECK(scene["device_bytes"] > 100000);
  for (const auto& loop : scene["cpp_loops"]) {
    CHECK(loop["ms_median"] > 0);
    CHECK(loop["mean_colour_difference"] < 1e-5);
  }
  for (const char* step : {"forward", "forward_all", "forward_pose", "forward_full", "mapping",
                           "tracking_adam", "tracking_gauss_newton"}) {
    CAPTURE(step);
    CHECK(scene["steps"][step]["ms_median"] > 0);
    double shares = 0;
    for (const auto& pass : scene["steps"][step]["passes"]) shares += pass["share"].get<double>();
    CHECK(shares == doctest::Approx(1));
  }
  const auto has_pass = [&](const char* step, const char* name) {
    const auto& passes = scene["steps"][step]["passes"];
    return std::any_of(passes.begin(), passes.end(), [&](const auto& pass) { return pass["pass"] == name; });
  };
  CHECK(has_pass("mapping", "update_gaussians"));
  CHECK(has_pass("tracking_adam", "track_step"));
  CHECK(has_pass("tracking_gauss_newton", "align_step"));
  CHECK_FALSE(has_pass("forward_full", "update_gaussians"));
  CHECK(contains(outcome.out, "blend_backward_pose"));

  const Outcome same =
      surefield_command({"bench", "--compare", folder / "bench.json", folder / "bench.json"}, folder.path());
  CHECK(same.code == 0);
  CHECK(contains(same.out, "forward_full: blend_backward"));
  CHECK(contains(same.out, "1.000"));
}

TEST_CASE("bench compares the figures of two files and names the one that is none") {
  const TemporaryFolder folder;
  const auto result = [](const std::string& scene, double milliseconds) {
    const nlohmann::json times = {{"ms_median", milliseconds}, {"cpu_ms_median", 2 * milliseconds}};
    nlohmann::json loop = times;
    loop["instructions"] = "AVX2";
    const nlohmann::json entry = {{"scene", scene},   {"cpp_loops", {loop}}, {"steps", {{"forward", times}}},
                                  {"instances", 10},  {"pairs", 640},        {"pairs_blended", 100},
                                  {"device_bytes", 5}};
    return nlohmann::json{{"schema", "surefield-bench"},
                          {"program", {{"commit", "abc"}}},
                          {"device", {{"name", "card"}, {"driver", "1.2"}}},
                          {"peak", {{"gflops", 50}}},
                          {"scenes", {entry}}}
        .dump();
  };
  const auto a = folder.write("a.json", result("medium", 4)), b = folder.write("b.json", result("medium", 3));
  const auto other = folder.write("other.json", result("large", 3));
  const auto none = folder.write("none.json", R"({"schema": "surefield-metrics"})");
  const auto torn = folder.write("torn.json", R"({"schema": "surefield-bench", "device": {}})");
  const auto compare = [&](const std::filesystem::path& first, const std::filesystem::path& second) {
    return surefield_command({"bench", "--compare", first, second}, folder.path());
  };
  const Outcome good = compare(a, b);
  CHECK(good.code == 0);
  CHECK(contains(good.out, "card, 1.2, commit abc"));
  CHECK(contains(good.out, "0.750"));
  CHECK(contains(good.out, "1.000"));
  CHECK(contains(compare(b, a).out, "1.333"));
  for (const auto& wrong : {other, none, torn, folder / "missing.json"}) {
    CAPTURE(wrong);
    const Outcome bad = compare(a, wrong);
    CHECK(bad.code == 2);
    CHECK(contains(bad.err, wrong.filename().string()));
    CHECK(std::count(bad.err.begin(), bad.err.end(), '\n') == 1);
  }
}
