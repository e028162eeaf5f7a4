#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "engine/primitives/reduce.h"
#include "tests/primitives/device_data.h"
#include "tests/support/device.h"

using namespace surefield;

namespace {

std::vector<float> random_floats(uint32_t seed, std::size_t count) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0.5f, 1.0f);
  std::vector<float> values(count);
  for (float& value : values) value = normal(random);
  return values;
}

/// The sum in the order of shaders/sort/reduce_chunks.comp and reduce_total.comp.
float ordered_sum(const std::vector<float>& values) {
  const std::size_t chunk = std::max<std::size_t>(
      glsl::REDUCE_CHUNK_LEAST, (values.size() + glsl::REDUCE_CHUNKS - 1) / glsl::REDUCE_CHUNKS);
  std::vector<float> lanes(glsl::REDUCE_LANES, 0.0f);
  for (std::size_t begin = 0, c = 0; begin < values.size(); begin += chunk, ++c) {
    float sum = 0;
    for (std::size_t i = begin; i < std::min(begin + chunk, values.size()); ++i) sum += values[i];
    lanes[c % lanes.size()] += sum;
  }
  for (std::size_t half = lanes.size() / 2; half > 0; half /= 2)
    for (std::size_t lane = 0; lane < half; ++lane) lanes[lane] += lanes[lane + half];
  return lanes[0];
}

float device_sum(gpu::Device& device, Reduce& reduce, const std::vector<float>& values, uint32_t count) {
  const auto source = testing::upload(device, "values", values);
  gpu::Array<float> result(device, "result");
  const testing::HeldCount held(device, count, static_cast<uint32_t>(values.size()));
  gpu::Recorder recorder(device);
  reduce.sum(recorder, source, result, held);
  recorder.submit();
  return result.download(1)[0];
}

}  // namespace

TEST_CASE("sums of floats are close to sums of doubles") {
  gpu::Device& device = testing::device();
  Reduce reduce(device);
  for (uint32_t size : {0u, 1u, 2u, 63u, 64u, 65u, 255u, 256u, 257u, 4097u, 65537u, 1u << 20}) {
    CAPTURE(size);
    const auto values = random_floats(size, size);
    double magnitude = 0;
    for (float value : values) magnitude += std::abs(value);
    CHECK(std::abs(device_sum(device, reduce, values, size) -
                   std::accumulate(values.begin(), values.end(), 0.0)) <= 2e-6 * magnitude);
  }
}

TEST_CASE("sums of floats depend on the count alone, bit for bit") {
  gpu::Device& device = testing::device();
  Reduce reduce(device);
  const auto values = random_floats(3, 500000);
  for (uint32_t count : {100u, 10000u, 300001u}) {
    const float sum = device_sum(device, reduce, values, count);
    Reduce another(device);
    CHECK(std::bit_cast<uint32_t>(device_sum(device, another, values, count)) ==
          std::bit_cast<uint32_t>(sum));
    const std::vector<float> exact(values.begin(), values.begin() + count);
    CHECK(std::bit_cast<uint32_t>(device_sum(device, reduce, exact, count)) == std::bit_cast<uint32_t>(sum));
  }
}

TEST_CASE("sums of floats bind through descriptor pools as well, with the same bits") {
  Reduce pushed(testing::device()), pooled(testing::pool_device());
  const auto values = random_floats(4, 70000);
  CHECK(device_sum(testing::device(), pushed, values, 70000) ==
        device_sum(testing::pool_device(), pooled, values, 70000));
}

TEST_CASE("[slow] sums of floats follow the documented order") {
  gpu::Device& device = testing::device();
  Reduce reduce(device);
  std::mt19937 random(13);
  for (uint32_t round = 0; round < 30; ++round) {
    const uint32_t size = testing::random_size(random, 20);
    const auto values = random_floats(round, size);
    CAPTURE(size);
    CHECK(device_sum(device, reduce, values, size) == ordered_sum(values));
  }
}
