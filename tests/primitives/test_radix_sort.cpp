#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <numeric>

#include "engine/primitives/radix_sort.h"
#include "tests/primitives/device_data.h"
#include "tests/support/device.h"

using namespace surefield;

namespace {

/// Sorts the first `count` pairs (key, position) on the device and compares with std::stable_sort.
void check_sort(gpu::Device& device, RadixSort& sort, const std::vector<uint32_t>& keys, uint32_t count,
                uint32_t bits) {
  CAPTURE(keys.size());
  CAPTURE(count);
  CAPTURE(bits);
  std::vector<uint32_t> order(keys.size());
  std::iota(order.begin(), order.end(), 0u);
  auto device_keys = testing::upload(device, "keys", keys);
  auto device_values = testing::upload(device, "values", order);
  const testing::HeldCount held(device, count, static_cast<uint32_t>(keys.size()));
  gpu::Recorder recorder(device);
  sort.record(recorder, device_keys, device_values, held, bits);
  recorder.submit();

  const auto mask = static_cast<uint32_t>((uint64_t{1} << bits) - 1);
  std::stable_sort(order.begin(), order.begin() + count,
                   [&](uint32_t a, uint32_t b) { return (keys[a] & mask) < (keys[b] & mask); });
  std::vector<uint32_t> expected;
  for (uint32_t index : order) expected.push_back(keys[index]);
  order.resize(count);
  expected.resize(count);
  CHECK(device_values.download(count) == order);
  CHECK(device_keys.download(count) == expected);
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

TEST_CASE("radix sort copes with keys in every order") {
  gpu::Device& device = testing::device();
  RadixSort sort(device);
  constexpr uint32_t kCount = 30001;
  std::vector<uint32_t> keys = testing::random_words(9, kCount);
  SUBCASE("sorted") {
    std::sort(keys.begin(), keys.end());
  }
  SUBCASE("reversed") {
    std::sort(keys.begin(), keys.end(), std::greater<>());
  }
  SUBCASE("all equal") {
    std::fill(keys.begin(), keys.end(), 0x12345678u);
  }
  SUBCASE("all zero") {
    std::fill(keys.begin(), keys.end(), 0u);
  }
  SUBCASE("all ones") {
    std::fill(keys.begin(), keys.end(), 0xffffffffu);
  }
  SUBCASE("few distinct, largest among them") {
    for (uint32_t& key : keys) key = key % 3 ? 0xffffffffu : key % 5;
  }
  check_sort(device, sort, keys, kCount, 32);
}

TEST_CASE("radix sort sorts no more than the count") {
  gpu::Device& device = testing::device();
  RadixSort sort(device);
  const auto keys = testing::random_words(8, 70000);
  for (uint32_t count : {0u, 1u, 100u, 65536u, 69999u}) check_sort(device, sort, keys, count, 32);
}

TEST_CASE("radix sort gives the same result in every shape") {
  gpu::Device& device = testing::device();
  const auto keys = testing::random_words(10, 100003);
  for (const SortShape& shape :
       {SortShape{.group_size = 16, .columns = 512, .chunk_least = 512, .offsets_team = 1},
        SortShape{.group_size = 32, .columns = 8192, .chunk_least = 32, .offsets_team = 256},
        SortShape{.group_size = 1, .columns = 7, .chunk_least = 1, .offsets_team = 2},
        SortShape{.group_size = 24, .columns = 1000, .chunk_least = 10, .offsets_team = 128}}) {
    CAPTURE(shape.group_size);
    RadixSort sort(device, shape);
    for (uint32_t count : {50u, 9999u, 100003u})
      for (uint32_t bits : {5u, 11u, 22u, 32u}) check_sort(device, sort, keys, count, bits);
  }
}

TEST_CASE("radix sort binds through descriptor pools as well") {
  gpu::Device& device = testing::pool_device();
  RadixSort sort(device);
  check_sort(device, sort, testing::random_words(11, 40000), 40000, 32);
}

TEST_CASE("radix sort grows between sorts of one recording") {
  gpu::Device& device = testing::device();
  uint32_t bits = 32;
  SUBCASE("an even number of digits") {}
  SUBCASE("an odd number of digits") {
    bits = 24;
  }
  RadixSort sort(device);
  gpu::Recorder recorder(device);
  std::vector<std::vector<uint32_t>> inputs;
  std::vector<gpu::Array<glsl::uint>> keys, values;
  std::vector<testing::HeldCount> counts;
  for (uint32_t size : {100u, 5000u, 200u, 60000u}) {
    inputs.push_back(testing::random_words(size, size, bits));
    keys.push_back(testing::upload(device, "keys", inputs.back()));
    values.push_back(testing::upload(device, "values", inputs.back()));
    counts.emplace_back(device, size, size);
  }
  for (std::size_t i = 0; i < inputs.size(); ++i) sort.record(recorder, keys[i], values[i], counts[i], bits);
  recorder.submit();
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    std::sort(inputs[i].begin(), inputs[i].end());
    CHECK(keys[i].download(inputs[i].size()) == inputs[i]);
    CHECK(values[i].download(inputs[i].size()) == inputs[i]);
  }
}

TEST_CASE("radix sort never moves more pairs than the capacity") {
  gpu::Device& device = testing::device();
  RadixSort sort(device);
  auto keys = testing::random_words(12, 1000);
  auto device_keys = testing::upload(device, "keys", keys);
  auto device_values = testing::upload(device, "values", keys);
  const testing::HeldCount too_many(device, 5000, 600);
  gpu::Recorder recorder(device);
  sort.record(recorder, device_keys, device_values, too_many, 32);
  recorder.submit();
  std::sort(keys.begin(), keys.begin() + 600);
  CHECK(device_keys.download(1000) == keys);
}

TEST_CASE("[slow] radix sort equals std::stable_sort on random sizes, counts and bits") {
  gpu::Device& device = testing::device();
  RadixSort sort(device);
  std::mt19937 random(13);
  for (uint32_t round = 0; round < 60; ++round) {
    const uint32_t size = testing::random_size(random, 19);
    check_sort(device, sort, testing::random_words(round, size, 1 + testing::random_below(random, 32)),
               testing::random_below(random, size + 1), testing::random_below(random, 33));
  }
}
