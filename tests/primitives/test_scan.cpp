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
