#include <doctest/doctest.h>

#include "engine/gpu/recorder.h"
#include "shaders/shared/test_scale.h"
#include "tests/support/device.h"

using namespace surefield;

TEST_CASE("a pass that reads what an earlier pass wrote sees it") {
  gpu::Device& device = testing::device();
  gpu::Pass<passes::test_scale> scale(device, 64, {.REPEATS = 2});
  gpu::Array<float> offsets(device, "offsets", 1000), values(device, "values", 1000);
  offsets.upload(std::vector<float>(1000, 1.0f));
  values.upload(std::vector<float>(1000, 3.0f));
  gpu::Recorder recorder(device);
  recorder.enable_timestamps();
  for (int i = 0; i < 3; ++i)
    recorder.dispatch(scale, scale.groups(1000), {.offsets = offsets, .values = values},
                      {.count = 1000, .factor = 2});
  const auto times = recorder.submit();
  CHECK(times.size() == 3);
  // x -> 2 x + 1 six times: 64 x + 63.
  for (float v : values.download(1000)) CHECK(v == 64 * 3.0f + 63);
}
