// OpenNI2's Dummy device, which Debian's package brings.
#include "engine/sources/openni_source.h"

#include <doctest/doctest.h>

#include <future>
#include <thread>

#include "engine/sources/open_live.h"
#include "tests/support/input_files.h"

using namespace surefield;
using namespace surefield::test;

namespace {

/// The Dummy device; null, with a message, where the build or the machine has no OpenNI2.
std::unique_ptr<FrameSource> dummy() {
  try {
    return open_live("openni2:Dummy").source;
  } catch (const InputError& error) {
    MESSAGE("skipped: ", error.what());
    CHECK(contains(error.what(), "openni2"));
    return nullptr;
  }
}

}  // namespace

TEST_CASE("a camera of OpenNI2 gives pairs of images, drops what nobody takes, and stops") {
  const auto camera = dummy();
  if (!camera) return;
  CHECK(camera->intrinsics().width == 320);
  CHECK(camera->intrinsics().height == 240);
  CHECK_FALSE(camera->assumptions().empty());
  double stamp = -1;
  for (int i = 0; i < 3; ++i) {
    const auto frame = camera->next();
    REQUIRE(frame);
    CHECK(frame->colour.size() == cv::Size(320, 240));
    CHECK(frame->depth.size() == cv::Size(320, 240));
    CHECK(frame->timestamp > stamp);
    CHECK(frame->arrived);
    stamp = frame->timestamp;
  }
  const uint64_t before = camera->live()->dropped;
  while (camera->live()->dropped < before + 2) std::this_thread::yield();
  CHECK(camera->live()->arrived >= 5);
  auto rest = std::async(std::launch::async, [&] {
    while (camera->next()) {
    }
  });
  camera->stop();
  rest.get();
  CHECK_FALSE(camera->next());
}

TEST_CASE("a camera that is not there is named") {
  if (!dummy()) return;
  CHECK(contains(input_error([] { open_openni("no such camera"); }), "no such camera"));
}
