#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "engine/gpu/error.h"
#include "tests/gpu/scale.h"
#include "tests/support/device.h"

using namespace surefield;
using testing::constant_array;

TEST_CASE("a dispatch of no workgroups records nothing") {
  gpu::Device& device = testing::device();
  const testing::Scale scale(device);
  const auto ones = constant_array(device, "ones", 100, 1), values = constant_array(device, "values", 100, 5);
  gpu::Recorder recorder(device);
  recorder.enable_timestamps();
  scale.record(recorder, ones, values, 0);
  recorder.dispatch(scale.pass(), 1, 0, {.offsets = ones, .values = values}, {.count = 100, .factor = 1});
  recorder.fill(values, 0, 0);
  CHECK(recorder.submit().empty());
  CHECK(values.download(100) == std::vector<float>(100, 5.0f));
}

TEST_CASE("an empty recording can be submitted, and a recording dropped") {
  gpu::Device& device = testing::device();
  const testing::Scale scale(device);
  const auto ones = constant_array(device, "ones", 100, 1), values = constant_array(device, "values", 100, 5);
  {
    gpu::Recorder dropped(device);
    scale.record(dropped, ones, values, 100);
  }
  gpu::Recorder recorder(device);
  recorder.submit();
  recorder.submit();
  CHECK(values.download(100) == std::vector<float>(100, 5.0f));
}

TEST_CASE("timestamps name every dispatch, submission by submission") {
  gpu::Device& device = testing::device();
  if (device.limits().timestamp_ns == 0) return;
  const testing::Scale scale(device);
  const auto ones = constant_array(device, "ones", 10000, 1),
             values = constant_array(device, "values", 10000, 0);
  gpu::Recorder recorder(device);
  recorder.enable_timestamps(4);
  for (uint32_t dispatches : {3u, 1u, 4u, 6u}) {
    for (uint32_t i = 0; i < dispatches; ++i) scale.record(recorder, ones, values, 10000);
    const auto times = recorder.submit();
    CHECK(times.size() == std::min(dispatches, 4u));  // those beyond the capacity are run, not timed
    for (const gpu::PassTime& time : times) {
      CHECK(std::string(time.pass) == "test_scale");
      CHECK(time.milliseconds >= 0);
      CHECK(time.milliseconds < 10000);
    }
  }
  CHECK(values.download(1)[0] == 3 + 1 + 4 + 6);
}

TEST_CASE("a device that times passes gathers the times of all recorders, and only while it does") {
  gpu::Device& device = testing::device();
  if (device.limits().timestamp_ns == 0) return;
  const testing::Scale scale(device);
  const auto ones = constant_array(device, "ones", 10, 1), values = constant_array(device, "values", 10, 0);
  const auto dispatch_in_two_recorders = [&] {
    gpu::Recorder first(device), second(device);
    scale.record(first, ones, values, 10);
    scale.record(second, ones, values, 10);
    first.submit();
    scale.record(first, ones, values, 10);
    second.submit();
    first.submit();
  };
  device.time_passes(true);
  dispatch_in_two_recorders();
  device.time_passes(false);
  dispatch_in_two_recorders();
  const auto times = device.take_pass_times();
  CHECK(times.size() == 3);
  for (const gpu::PassTime& time : times) CHECK(std::string(time.pass) == "test_scale");
  CHECK(device.take_pass_times().empty());
}

TEST_CASE("a recorder without timestamps returns no times") {
  gpu::Device& device = testing::device();
  const testing::Scale scale(device);
  const auto ones = constant_array(device, "ones", 10, 1), values = constant_array(device, "values", 10, 0);
  gpu::Recorder recorder(device);
  scale.record(recorder, ones, values, 10);
  CHECK(recorder.submit().empty());
}

TEST_CASE(
    "push descriptors and descriptor pools give the same result, more dispatches than a pool has sets") {
  CHECK_FALSE(testing::pool_device().limits().push_descriptors);
  std::vector<std::vector<float>> results;
  for (gpu::Device* device : {&testing::device(), &testing::pool_device()}) {
    const testing::Scale scale(*device);
    const auto offsets = constant_array(*device, "offsets", 1000, 0.1f);
    const auto values = constant_array(*device, "values", 1000, 0.7f);
    gpu::Recorder recorder(*device);
    for (int submission = 0; submission < 3; ++submission) {
      for (int i = 0; i < 300; ++i) scale.record(recorder, offsets, values, 1000, 0.99f);
      recorder.submit();
    }
    results.push_back(values.download(1000));
  }
  CHECK(results[0] == results[1]);
}

TEST_CASE("dispatches beyond the limits of the device are refused") {
  gpu::Device& device = testing::device();
  const testing::Scale scale(device);
  const auto a = constant_array(device, "a", 64, 1), b = constant_array(device, "b", 64, 0);
  gpu::Recorder recorder(device);
  const passes::test_scale::Bindings bindings{.offsets = a, .values = b};
  const passes::test_scale::Params params{.count = 64, .factor = 1};
  if (device.limits().workgroups_x < UINT32_MAX)
    CHECK_THROWS_AS(recorder.dispatch(scale.pass(), device.limits().workgroups_x + 1, bindings, params),
                    gpu::Error);
  if (device.limits().workgroups_y < UINT32_MAX)
    CHECK_THROWS_AS(recorder.dispatch(scale.pass(), 1, device.limits().workgroups_y + 1, bindings, params),
                    gpu::Error);
  gpu::Array<gpu::DispatchArgs> arguments(device, "arguments", 4);
  CHECK_THROWS_WITH_AS(recorder.dispatch_indirect(scale.pass(), arguments, 4, bindings, params),
                       "dispatching indirectly beyond the end of arguments", gpu::Error);
}

TEST_CASE("a binding larger than the device allows is refused with both sizes") {
  gpu::Device& device = testing::device();
  const uint64_t range = device.limits().storage_range_bytes;
  if (range > (uint64_t{1} << 28)) return;  // too large to try
  const testing::Scale scale(device);
  const gpu::Array<float> too_large(device, "too large", range / sizeof(float) + 4);
  const auto values = constant_array(device, "values", 64, 0);
  gpu::Recorder recorder(device);
  try {
    scale.record(recorder, too_large, values, 64);
    FAIL("accepted");
  } catch (const gpu::Error& error) {
    CHECK(error.kind() == gpu::Error::Kind::Limit);
    const std::string megabytes = std::to_string((range + 500000) / 1000000);
    CHECK(std::string(error.what())
              .find("pass test_scale: offsets needs " + megabytes + " MB in one binding") == 0);
  }
}

TEST_CASE("a recorder remains usable after a refusal") {
  gpu::Device& device = testing::device();
  const testing::Scale scale(device);
  const auto ones = constant_array(device, "ones", 64, 1), values = constant_array(device, "values", 64, 0);
  gpu::Recorder recorder(device);
  scale.record(recorder, ones, values, 64);
  CHECK_THROWS_AS(recorder.fill(values, 1000, 0), gpu::Error);
  scale.record(recorder, ones, values, 64);
  recorder.submit();
  CHECK(values.download(64) == std::vector<float>(64, 2.0f));
}
