#include <doctest/doctest.h>

#include <bit>
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
