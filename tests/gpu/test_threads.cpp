#include <doctest/doctest.h>

#include <atomic>
#include <thread>

#include "tests/gpu/scale.h"
#include "tests/support/device.h"

using namespace surefield;

namespace {

/// Submits many small recordings from several threads that share the device and the pass; returns how many
/// threads found the right result.
int count_correct_threads(gpu::Device& device, uint32_t threads) {
  const testing::Scale scale(device);
  std::atomic<int> correct{0};
  std::vector<std::thread> workers;
  for (uint32_t t = 0; t < threads; ++t)
    workers.emplace_back([&, t] {
      const auto offsets = testing::constant_array(device, "offsets", 2000, static_cast<float>(t));
      const auto values = testing::constant_array(device, "values", 2000, 0);
      gpu::Recorder recorder(device);
      for (int submission = 0; submission < 20; ++submission) {
        for (int i = 0; i < 5; ++i) scale.record(recorder, offsets, values, 2000);
        recorder.submit();
      }
      if (values.download(2000) == std::vector<float>(2000, 100.0f * static_cast<float>(t))) ++correct;
    });
  for (std::thread& worker : workers) worker.join();
  return correct;
}

}  // namespace

TEST_CASE("several threads record and submit at once") {
  CHECK(count_correct_threads(testing::device(), 4) == 4);
}

TEST_CASE("several threads record and submit at once through descriptor pools") {
  CHECK(count_correct_threads(testing::pool_device(), 4) == 4);
}
