#include <doctest/doctest.h>

#include <vector>

#include "engine/slam/slam.h"
#include "engine/synth/synthetic_recording.h"
#include "tests/support/device.h"

using namespace surefield;

namespace {

constexpr int kFrames = 18;
constexpr int kFirstSteady = 12;  // four keyframes, as many as frames are aligned to, have been made

struct FrameUse {
  bool keyframe = false;
  gpu::DeviceCounters use;
};

SlamSettings quick(TrackingMethod method) {
  SlamSettings settings;
  settings.sensor = DepthSensor::Perfect;
  settings.first_iterations = 10;
  settings.mapping_iterations = 4;
  settings.keyframes.interval = 3;
  settings.tracking.method = method;
  settings.tracking.adam.iterations = settings.tracking.adam.first_iterations = 8;
  return settings;
}

/// What every frame of a run over the synthetic office asks of the device.
std::vector<FrameUse> run(const SlamSettings& settings) {
  const SyntheticRecording recording(testing::device_options(),
                                     {.width = 96, .height = 72, .frames = kFrames});
  Slam slam(settings, recording.intrinsics(),
            {.device = testing::device_options().selector, .validate = true});
  std::vector<FrameUse> frames;
  for (int i = 0; i < kFrames; ++i) {
    const Frame frame = *recording.load(i).frame;
    const gpu::DeviceCounters before = slam.engine_report().device_use;
    const FrameReport report = slam.feed(frame);
    CHECK_FALSE(report.lost());
    frames.push_back({report.keyframe, slam.engine_report().device_use - before});
  }
  CHECK(slam.engine_report().validation_messages.empty());
  return frames;
}

}  // namespace

TEST_CASE("a frame that becomes no keyframe allocates nothing") {
  for (const TrackingMethod method : {TrackingMethod::GaussNewton, TrackingMethod::Adam}) {
    const std::vector<FrameUse> frames = run(quick(method));
    for (int i = kFirstSteady; i < kFrames; ++i) {
      CAPTURE(i);
      const FrameUse& frame = frames[static_cast<std::size_t>(i)];
      if (frame.keyframe) continue;
      CHECK(frame.use.allocations == 0);
      CHECK(frame.use.objects == 0);
    }
  }
}
