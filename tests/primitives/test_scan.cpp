#include <doctest/doctest.h>

#include <numeric>

#include "engine/primitives/scan.h"
#include "tests/primitives/device_data.h"
#include "tests/support/device.h"

using namespace surefield;

namespace {

constexpr uint32_t kUntouched = 0xabcdef01;

/// Scans the first `count` of `input` on the device and compares with std::exclusive_scan, also that nothing
/// is written behind them.
void check_scan(gpu::Device& device, ExclusiveScan& scan, const std::vector<uint32_t>& input,
                uint32_t count) {
  CAPTURE(input.size());
  CAPTURE(count);
  const auto capacity = static_cast<uint32_t>(input.size());
  const auto source = testing::upload(device, "input", input);
  const auto target = testing::upload(device, "output", std::vector<uint32_t>(input.size(), kUntouched));
  gpu::Array<glsl::uint> total(device, "total");
  const testing::HeldCount held(device, count, capacity);
  gpu::Recorder recorder(device);
  scan.record(recorder, source, target, total, held);
  recorder.submit();

  std::vector<uint32_t> expected(input.size(), kUntouched);
  std::exclusive_scan(input.begin(), input.begin() + count, expected.begin(), 0u);
  CHECK(target.download(input.size()) == expected);
  CHECK(total.download(1)[0] == std::accumulate(input.begin(), input.begin() + count, 0u));
}

}  // namespace

TEST_CASE("exclusive scan equals std::exclusive_scan at all sizes") {
  gpu::Device& device = testing::device();
  ExclusiveScan scan(device);
  for (uint32_t size : {0u, 1u, 2u, 31u, 255u, 256u, 257u, 4097u, 65537u, 1u << 20})
    check_scan(device, scan, testing::random_words(size, size, 8), size);
}

TEST_CASE("exclusive scan stops at a count below the capacity") {
  gpu::Device& device = testing::device();
  ExclusiveScan scan(device);
  const auto input = testing::random_words(5, 70000);  // sums wrap around
  for (uint32_t count : {0u, 1u, 100u, 65536u, 69999u}) check_scan(device, scan, input, count);
}

TEST_CASE("exclusive scan gives the same result in every shape") {
  gpu::Device& device = testing::device();
  const auto input = testing::random_words(6, 100003);
  for (const ScanShape& shape :
       {ScanShape{.group_size = 16, .groups = 8}, ScanShape{.group_size = 256, .groups = 1024},
        ScanShape{.group_size = 1, .groups = 3}, ScanShape{.group_size = 64, .groups = 1}}) {
    CAPTURE(shape.group_size);
    ExclusiveScan scan(device, shape);
    for (uint32_t count : {0u, 7u, 9999u, 100003u}) check_scan(device, scan, input, count);
  }
}

TEST_CASE("exclusive scan binds through descriptor pools as well") {
  gpu::Device& device = testing::pool_device();
  ExclusiveScan scan(device);
  check_scan(device, scan, testing::random_words(11, 40000), 40000);
}

TEST_CASE("exclusive scan never reads more elements than the capacity") {
  gpu::Device& device = testing::device();
  ExclusiveScan scan(device);
  const auto input = testing::upload(device, "input", std::vector<uint32_t>(1000, 1));
  const auto output = testing::upload(device, "output", std::vector<uint32_t>(1000, kUntouched));
  gpu::Array<glsl::uint> total(device, "total");
  const testing::HeldCount too_many(device, 5000, 600);
  gpu::Recorder recorder(device);
  scan.record(recorder, input, output, total, too_many);
  recorder.submit();
  CHECK(total.download(1)[0] == 600);
  CHECK(output.download(1, 599)[0] == 599);
  CHECK(output.download(1, 600)[0] == kUntouched);
}

TEST_CASE("[slow] exclusive scan equals std::exclusive_scan on random sizes and counts") {
  gpu::Device& device = testing::device();
  ExclusiveScan scan(device);
  std::mt19937 random(13);
  for (uint32_t round = 0; round < 60; ++round) {
    const uint32_t size = testing::random_size(random, 20);
    check_scan(device, scan, testing::random_words(round, size), testing::random_below(random, size + 1));
  }
}
