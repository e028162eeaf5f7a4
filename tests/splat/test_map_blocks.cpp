#include <doctest/doctest.h>

#include <algorithm>

#include "engine/splat/map_blocks.h"
#include "engine/splat/mapper.h"
#include "tests/splat/wall.h"
#include "tests/support/device.h"

using namespace surefield;

namespace {

constexpr uint64_t kBytes = 520;  // of device memory a Gaussian, as docs/design.md says

/// A place `x` blocks along the row.
Eigen::Vector3f at(float x) {
  return MapBlocks::kEdge * Eigen::Vector3f(x, 0.5f, 0.5f);
}

/// Gaussians along x through `blocks` blocks, four in each, all different.
GaussianCloud row(int blocks, int sh_degree = 0) {
  GaussianCloud cloud;
  cloud.sh_degree = sh_degree;
  cloud.resize(4 * blocks);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto x = static_cast<float>(i);
    cloud.means[i] = at(x / 4 + 0.1f);
    cloud.log_scales[i] = {-2 - x / 100, -3, -4};
    cloud.rotations[i] = {1, x / 50, 0, 0};
    cloud.opacity_logits[i] = x / 10 - 1;
    cloud.uncertainty[i] = x / 7;
    cloud.sampling[i] = x * 1e-6f;
    cloud.anchors[i] = static_cast<uint32_t>(i / 3);
  }
  for (std::size_t i = 0; i < cloud.sh.size(); ++i) cloud.sh[i] = static_cast<float>(i) / 97;
  return cloud;
}

/// Puts numbers into moments and statistics, so that it shows where they go.
void fill_state(GaussianMap& map) {
  map.for_each_array([&]<class T>(gpu::Array<T>& array, uint32_t words, bool state) {
    std::vector<uint32_t> numbers(map.size() * words);
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<uint32_t>(1000 * words + i);
    if (state) array.buffer().upload(numbers.data(), 0, numbers.size() * sizeof(uint32_t));
  });
}

/// Everything about every Gaussian, one record each, whatever their order on the device.
std::vector<std::vector<uint32_t>> sorted_records(GaussianMap& map) {
  const std::vector<uint32_t> words = map.read_records(0);
  std::vector<std::vector<uint32_t>> records;
  for (std::size_t at = 0; at < words.size(); at += map.record_words())
    records.emplace_back(words.begin() + static_cast<std::ptrdiff_t>(at),
                         words.begin() + static_cast<std::ptrdiff_t>(at + map.record_words()));
  std::sort(records.begin(), records.end());
  return records;
}

}  // namespace

TEST_CASE(
    "blocks far from what is looked at leave the device and come back bit by bit, with all their state") {
  for (int degree : {0, 2}) {
    GaussianMap map(testing::device());
    MapBlocks blocks(testing::device());
    map.assign(row(20, degree));
    fill_state(map);
    const auto before = sorted_records(map);

    const std::vector<WorldPoints> start{{at(2.5f)}};
    CHECK(blocks.focus(map, start, 0) == 1);
    CHECK(map.size() == 3 * 4);  // blocks 1 to 3
    CHECK(blocks.parked() == 17 * 4);
    for (const Eigen::Vector3f& mean : map.download().means)
      CHECK((mean.x() > at(1).x() && mean.x() < at(4).x()));
    CHECK_FALSE(blocks.is_whole(map, 0));

    CHECK(blocks.recall(map, {at(4.5f), at(18.2f) + Eigen::Vector3f(0, MapBlocks::kEdge, 0)}));
    CHECK(map.size() == (3 + 2 + 3) * 4);
    CHECK(blocks.recall(map, {at(4.5f), at(100)}));  // all there already, or nothing
    CHECK(map.size() == (3 + 2 + 3) * 4);

    WorldPoints everywhere;
    for (int x = 0; x < 20; ++x) everywhere.push_back(at(static_cast<float>(x)));
    CHECK(blocks.recall(map, everywhere));
    CHECK(blocks.parked() == 0);
    CHECK(blocks.is_whole(map, 0));
    CHECK(sorted_records(map) == before);
  }
}

TEST_CASE("the parts of a map on the device and in host memory make the whole cloud") {
  GaussianMap map(testing::device());
  MapBlocks blocks(testing::device());
  const GaussianCloud all = row(10, 1);
  map.assign(all);
  blocks.focus(map, std::vector<WorldPoints>{{at(9.5f)}}, 0);
  GaussianCloud cloud = map.download();
  CHECK(cloud.size() == 2 * 4);
  blocks.append_to(cloud, map);
  REQUIRE(cloud.size() == all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t was = (i + 8 * 4) % all.size();  // the last two blocks first
    CHECK(cloud.means[i] == all.means[was]);
    CHECK(cloud.log_scales[i] == all.log_scales[was]);
    CHECK(cloud.rotations[i] == all.rotations[was]);
    CHECK(cloud.opacity_logits[i] == all.opacity_logits[was]);
    CHECK(cloud.uncertainty[i] == all.uncertainty[was]);
    CHECK(cloud.sampling[i] == all.sampling[was]);
    CHECK(cloud.anchors[i] == all.anchors[was]);
    CHECK(std::equal(&cloud.sh[i * 12], &cloud.sh[i * 12] + 12, &all.sh[was * 12]));
  }
}

TEST_CASE(
    "as many regions as the budget holds are on the device, in their order; of the first, at least a part") {
  GaussianMap map(testing::device());
  MapBlocks blocks(testing::device());
  map.assign(row(40));
  const std::vector<WorldPoints> regions{{at(5.5f)}, {at(6.5f)}, {at(20.5f)}, {at(30.5f)}};
  blocks.set_budget(kBytes * 29);
  CHECK(blocks.limit(map) == 29);
  CHECK_FALSE(blocks.is_whole(map, 0));
  CHECK(blocks.focus(map, regions, 0) == 3);  // 3, 1 and 3 blocks more, of 4 each
  CHECK(map.size() == 28);
  CHECK(blocks.focus(map, regions, 2) == 2);  // those to be born need room too
  CHECK(map.size() == 16);
  CHECK(blocks.recall(map, regions[2]));
  CHECK_FALSE(blocks.recall(map, regions[3]));
  CHECK(map.size() == 28);
  blocks.set_budget(kBytes * 9);
  CHECK(blocks.focus(map, regions, 0) == 1);
  CHECK(map.size() == 8);  // the block of its place, and one beside it
  CHECK(map.size() + blocks.parked() == 160);
}

TEST_CASE("what little is not looked at stays on the device while there is room") {
  GaussianMap map(testing::device());
  MapBlocks blocks(testing::device());
  map.assign(row(20));
  WorldPoints most;
  for (int x = 1; x < 18; ++x) most.push_back(at(static_cast<float>(x) + 0.5f));
  CHECK(blocks.focus(map, std::vector<WorldPoints>{most}, 0) == 1);
  CHECK(blocks.is_whole(map, 0));
  CHECK(blocks.is_whole(map, 1u << 30));
  blocks.set_budget(kBytes * 80);
  CHECK(blocks.is_whole(map, 0));
  CHECK_FALSE(blocks.is_whole(map, 1));
  CHECK(blocks.focus(map, std::vector<WorldPoints>{most}, 1) == 1);
  CHECK(map.size() == 19 * 4);
}

TEST_CASE("an engine renders, counts and returns the whole map though a part waits in host memory") {
  SplatEngine engine({.device = testing::device_options().selector});
  const GaussianCloud wall = testing::wall(96, 72, 90);
  engine.assign(wall);
  const Camera camera = testing::wall_camera();
  const RenderImages whole = engine.render(camera);
  CHECK(engine.focus(std::vector<WorldPoints>{{{100, 100, 100}}}, 0) == 1);
  CHECK_FALSE(engine.is_whole());
  CHECK(engine.size() == wall.size());
  CHECK(engine.map().size() == wall.size());
  const RenderImages nothing = engine.render(camera);
  CHECK(*std::max_element(nothing.opacity.begin(), nothing.opacity.end()) == 0);
  const RenderImages again = engine.render_whole(camera);
  CHECK(*std::max_element(again.opacity.begin(), again.opacity.end()) > 0.5f);
  for (std::size_t i = 0; i < whole.opacity.size(); ++i)
    REQUIRE(again.opacity[i] == doctest::Approx(whole.opacity[i]).epsilon(1e-4));
  CHECK_FALSE(engine.is_whole());
  engine.assign(wall);
  CHECK(engine.is_whole());
}

TEST_CASE(
    "the Gaussians' device memory, with what rendering and optimising keep for each, is within the budget") {
  gpu::Device& device = testing::device();
  const Camera camera = testing::wall_camera();
  const uint64_t before = device.memory_in_use();
  uint64_t small = 0;
  for (const int length : {1, 50000}) {
    Rasteriser rasteriser(device);
    Mapper mapper(device);
    GaussianMap map(device);
    MapBlocks blocks(device);
    map.assign(row(length));
    const SensorFrame frame = testing::frame_of(device, rasteriser, map, camera);
    CameraVariable variable(device, camera);
    gpu::Recorder recorder(device);
    mapper.record_step(recorder, rasteriser, map, {frame, variable}, {}, 0.003);
    recorder.submit();
    if (length == 1) {
      small = device.memory_in_use() - before;
      continue;
    }
    const uint64_t used = device.memory_in_use() - before - small;  // without what every map needs
    blocks.set_budget(used * 3 / 2);                                // arrays grow by half
    CHECK(blocks.limit(map) < map.size());
    blocks.set_budget(used * 2);
    CHECK(blocks.limit(map) > map.size());
  }
}
