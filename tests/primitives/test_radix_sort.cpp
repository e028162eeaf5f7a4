#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>

#include "engine/primitives/radix_sort.h"
#include "tests/primitives/device_data.h"
#include "tests/support/device.h"

using namespace surefield;

namespace {

/// Sorts the first `count` pairs (key, position) on the device and compares with std::stable_sort; pairs
/// behind them must stay.
void check_sort(gpu::Device& device, RadixSort& sort, const std::vector<uint32_t>& keys, uint32_t count,
                uint32_t bits) {
  CAPTURE(keys.size());
  CAPTURE(count);
  CAPTURE(bits);
  std::vector<uint32_t> order(keys.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto device_keys = testing::upload(device, "keys", keys);
  const auto device_values = testing::upload(device, "values", order);
  const testing::HeldCount held(device, count, static_cast<uint32_t>(keys.size()));
  gpu::Recorder recorder(device);
  sort.record(recorder, device_keys, device_values, held, bits);
  recorder.submit();

  const auto mask = static_cast<uint32_t>((uint64_t{1} << bits) - 1);
  std::stable_sort(order.begin(), order.begin() + count,
                   [&](uint32_t a, uint32_t b) { return (keys[a] & mask) < (keys[b] & mask); });
  std::vector<uint32_t> expected;
  for (uint32_t index : order) expected.push_back(keys[index]);
  CHECK(device_values.download(keys.size()) == order);
  CHECK(device_keys.download(keys.size()) == expected);
}

}  // namespace

TEST_CASE("radix sort equals std::stable_sort at all sizes") {
  gpu::Device& device = testing::device();
  RadixSort sort(device);
  for (uint32_t size : {0u, 1u, 2u, 31u, 255u, 256u, 257u, 4097u, 65537u, 1u << 20})
    check_sort(device, sort, testing::random_words(size, size), size, 32);
}

TEST_CASE("radix sort looks at the lowest bits only, and is stable") {
  gpu::Device& device = testing::device();
  RadixSort sort(device);
  const auto keys = testing::random_words(7, 20011);
  for (uint32_t bits : {0u, 1u, 2u, 7u, 8u, 9u, 11u, 16u, 17u, 20u, 31u, 32u})
    check_sort(device, sort, keys, 20011, bits);
}

TEST_CASE("radix sort leaves what lies behind the count") {
  gpu::Device& device = testing::device();
  RadixSort sort(device);
  const auto keys = testing::random_words(8, 70000);
  for (uint32_t count : {0u, 1u, 100u, 65536u, 69999u}) check_sort(device, sort, keys, count, 32);
}
