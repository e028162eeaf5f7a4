#include <doctest/doctest.h>

#include "tests/gpu/scale.h"
#include "tests/support/device.h"

using namespace surefield;

TEST_CASE("a device counts the memory and the buffers that it makes") {
  gpu::Device& device = testing::device();
  const gpu::DeviceCounters before = device.counters();
  gpu::Array<float> array(device, "array", 10);
  CHECK((device.counters() - before).allocations == 1);
  CHECK((device.counters() - before).objects == 1);
  array.reserve(10);
  CHECK((device.counters() - before).allocations == 1);
  array.reserve(1000);
  CHECK((device.counters() - before).allocations == 2);
  CHECK((device.counters() - before).submissions == 0);
}

TEST_CASE("a new device has allocated its staging memory alone") {
  const gpu::Device device(testing::device_options());
  CHECK(device.counters().allocations == 1);
  CHECK(device.counters().submissions == 0);
  CHECK(device.memory_in_use() == 0);  // that of buffers
}

TEST_CASE("recorders that follow each other record with the same objects, those at one time do not") {
  for (gpu::Device* device : {&testing::device(), &testing::pool_device()}) {
    const testing::Scale scale(*device);
    const auto ones = testing::constant_array(*device, "ones", 64, 1);
    const auto values = testing::constant_array(*device, "values", 64, 0);
    const auto record = [&](gpu::Recorder& recorder) {
      for (int i = 0; i < 300; ++i) scale.record(recorder, ones, values, 64);  // more than a pool has sets
    };
    const auto two_at_one_time = [&] {
      gpu::Recorder first(*device), second(*device);
      first.enable_timestamps();
      record(first);
      record(second);
      second.submit();
      first.submit();
    };
    // Whichever of the objects the recorders get, all have been used with timestamps then.
    two_at_one_time();
    two_at_one_time();
    const gpu::DeviceCounters before = device->counters();
    two_at_one_time();
    for (int i = 0; i < 3; ++i) {
      gpu::Recorder recorder(*device);
      recorder.enable_timestamps(4);
      record(recorder);
      if (i < 2) recorder.submit();  // the last is dropped
    }
    const gpu::DeviceCounters use = device->counters() - before;
    CHECK(use.objects == 0);
    CHECK(use.allocations == 0);
    CHECK(use.submissions == 4);
    CHECK(values.download(64) == std::vector<float>(64, 2400.0f));
  }
}

TEST_CASE("timestamps of a recorder do not come back from the objects of an earlier one") {
  gpu::Device& device = testing::device();
  const testing::Scale scale(device);
  const auto ones = testing::constant_array(device, "ones", 64, 1);
  const auto values = testing::constant_array(device, "values", 64, 0);
  {
    gpu::Recorder timed(device);
    timed.enable_timestamps();
    scale.record(timed, ones, values, 64);
  }
  gpu::Recorder recorder(device);
  scale.record(recorder, ones, values, 64);
  CHECK(recorder.submit().empty());
}
