#include <doctest/doctest.h>

#include <numeric>

#include "engine/gpu/error.h"
#include "tests/gpu/scale.h"
#include "tests/support/device.h"

using namespace surefield;
using testing::constant_array;

namespace {

std::vector<float> counting(uint32_t count) {
  std::vector<float> values(count);
  std::iota(values.begin(), values.end(), 1.0f);
  return values;
}

}  // namespace

TEST_CASE("ranges of a buffer go up and come back") {
  gpu::Array<float> array(testing::device(), "array", 1000);
  array.upload(std::vector<float>(1000, 0.0f));
  array.upload(counting(10), 3);
  std::vector<float> expected(1000, 0.0f);
  std::iota(expected.begin() + 3, expected.begin() + 13, 1.0f);
  CHECK(array.download(1000) == expected);
  CHECK(array.download(5, 11) == std::vector<float>{9, 10, 0, 0, 0});
  CHECK(array.download(1, 999) == std::vector<float>{0});
}

TEST_CASE("empty uploads and downloads are nothing") {
  gpu::Array<float> array(testing::device(), "array", 0);
  array.upload({});
  CHECK(array.download(0).empty());
  CHECK(array.capacity() > 0);  // a buffer of no bytes cannot be bound
}

TEST_CASE("an upload grows the array and keeps what lies before it") {
  gpu::Array<float> array(testing::device(), "array", 8);
  array.upload(counting(8));
  array.upload(std::vector<float>{-1, -2}, 1000);
  CHECK(array.capacity() >= 1002);
  CHECK(array.download(8) == counting(8));
  CHECK(array.download(2, 1000) == std::vector<float>{-1, -2});
}

TEST_CASE("arrays grow with and without their contents") {
  gpu::Array<float> array(testing::device(), "array", 100);
  array.upload(counting(100));
  CHECK_FALSE(array.reserve(100));
  CHECK_FALSE(array.reserve(1));
  CHECK(array.reserve(101, true));
  CHECK(array.capacity() >= 150);  // by half, so that growing step by step is cheap
  CHECK(array.download(100) == counting(100));
  CHECK(array.reserve(10000));
  CHECK(array.capacity() >= 10000);
  array.upload(counting(10000));
  CHECK(array.download(10000) == counting(10000));
}

TEST_CASE("growth stops at what one binding can span, unless more is asked for") {
  gpu::Device& device = testing::device();
  const uint64_t range = device.limits().storage_range_bytes;
  if (range > (uint64_t{1} << 28)) return;  // too large to try
  gpu::Buffer buffer(device, "large", range / 10 * 8);
  CHECK(buffer.grown_bytes(range / 10 * 9) <= range);
  CHECK(buffer.grown_bytes(range * 3) == range * 3);
}

TEST_CASE("a recorder grows an array that recorded work uses") {
  gpu::Device& device = testing::device();
  const testing::Scale scale(device);
  const auto ones = constant_array(device, "ones", 5000, 1);
  auto scratch = constant_array(device, "scratch", 64, 3);
  const auto sum = constant_array(device, "sum", 5000, 0);
  const uint64_t before = device.memory_in_use();
  gpu::Recorder recorder(device);
  scale.record(recorder, scratch, sum, 64);  // + 3 to the first 64
  recorder.reserve(scratch, 5000);
  recorder.fill(scratch, 5000, 0);
  scale.record(recorder, ones, scratch, 5000);  // 1
  scale.record(recorder, scratch, sum, 5000);   // + 1
  recorder.reserve(scratch, 5000);              // large enough: nothing happens
  CHECK(device.memory_in_use() >= before + 5000 * sizeof(float));
  recorder.submit();
  CHECK(device.memory_in_use() < before + 5000 * sizeof(float));  // the old memory is free again
  CHECK(sum.download(1)[0] == 4);
  CHECK(sum.download(1, 4999)[0] == 1);
}

TEST_CASE("buffers move, and memory is accounted for") {
  gpu::Device& device = testing::device();
  const uint64_t before = device.memory_in_use();
  {
    gpu::Array<float> first(device, "first", 1000);
    CHECK(device.memory_in_use() >= before + 4000);
    first.upload(counting(1000));
    gpu::Array<float> second(std::move(first));
    CHECK(second.download(1000) == counting(1000));
    gpu::Array<float> third(device, "third", 10);
    third = std::move(second);
    CHECK(third.download(1000) == counting(1000));
    CHECK(third.buffer().name() == "first");
    CHECK(device.memory_peak() >= before + 4000);
  }
  CHECK(device.memory_in_use() == before);
}

TEST_CASE("ranges beyond the end are refused with the buffer's name") {
  gpu::Device& device = testing::device();
  gpu::Array<float> array(device, "narrow", 100);
  const float value = 0;
  CHECK_THROWS_WITH_AS(array.buffer().upload(&value, 400, 4), "upload beyond the end of narrow", gpu::Error);
  CHECK_THROWS_WITH_AS(array.download(1, 100), "download beyond the end of narrow", gpu::Error);
  CHECK_THROWS_AS(array.download(101), gpu::Error);
  gpu::Recorder recorder(device);
  CHECK_THROWS_WITH_AS(recorder.fill(array, 101, 0), "filling beyond the end of narrow", gpu::Error);
  gpu::Array<float> wide(device, "wide", 200);
  CHECK_THROWS_WITH_AS(recorder.copy(testing::first_entries(wide, 101), testing::first_entries(array, 100)),
                       "copying to beyond the end of narrow", gpu::Error);
  CHECK_THROWS_WITH_AS(recorder.copy(testing::first_entries(array, 101), testing::first_entries(wide, 101)),
                       "copying from beyond the end of narrow", gpu::Error);
}
