#include <doctest/doctest.h>

#include "engine/gpu/error.h"
#include "engine/primitives/radix_sort.h"
#include "engine/primitives/reduce.h"
#include "engine/primitives/scan.h"
#include "tests/primitives/device_data.h"
#include "tests/support/device.h"

using namespace surefield;

TEST_CASE("a capacity beyond the end of an array is refused with the array's name") {
  gpu::Device& device = testing::device();
  gpu::Array<glsl::uint> wide(device, "wide", 1000), narrow(device, "narrow", 100), total(device, "total");
  gpu::Array<float> few(device, "few", 100), result(device, "result");
  const testing::HeldCount count(device, 10, 1000);
  gpu::Recorder recorder(device);
  ExclusiveScan scan(device);
  RadixSort sort(device);
  Reduce reduce(device);
  const char* message = "narrow has no room for 1000 elements";
  CHECK_THROWS_WITH_AS(scan.record(recorder, narrow, wide, total, count), message, gpu::Error);
  CHECK_THROWS_WITH_AS(scan.record(recorder, wide, narrow, total, count), message, gpu::Error);
  CHECK_THROWS_WITH_AS(sort.record(recorder, narrow, wide, count, 32), message, gpu::Error);
  CHECK_THROWS_WITH_AS(sort.record(recorder, wide, narrow, count, 32), message, gpu::Error);
  CHECK_THROWS_WITH_AS(reduce.sum(recorder, few, result, count), "few has no room for 1000 elements",
                       gpu::Error);
}
