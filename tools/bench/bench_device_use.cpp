#include "tools/bench/bench_device_use.h"

#include <algorithm>

#include "engine/slam/slam.h"
#include "engine/synth/synthetic_recording.h"
#include "tools/shared/progress_line.h"

namespace surefield {

namespace {

constexpr int kWidth = 160, kHeight = 120, kFrames = 60;
constexpr int kKeyframeInterval = 5;
// By then the window is full, and keyframes have begun to leave the device for host memory.
constexpr int kFirstCounted = 40;

}  // namespace

void FrameUse::add(const gpu::DeviceCounters& frame) {
  ++frames;
  for (const auto figure :
       {&gpu::DeviceCounters::submissions, &gpu::DeviceCounters::allocations, &gpu::DeviceCounters::objects,
        &gpu::DeviceCounters::bytes_uploaded, &gpu::DeviceCounters::bytes_read_back}) {
    total.*figure += frame.*figure;
    most.*figure = std::max(most.*figure, frame.*figure);
  }
}

DeviceUse measure_device_use(const std::string& device) {
  const SyntheticRecording recording({.selector = device},
                                     {.width = kWidth, .height = kHeight, .frames = kFrames});
  SlamSettings settings;
  settings.sensor = DepthSensor::Perfect;
  settings.keyframes.interval = kKeyframeInterval;
  Slam slam(settings, recording.intrinsics(), {.device = device});
  DeviceUse use{.frames = kFrames, .width = kWidth, .height = kHeight};
  ProgressLine progress("slam");
  for (int i = 0; i < kFrames; ++i) {
    const Frame frame = *recording.load(i).frame;
    const gpu::DeviceCounters before = slam.engine_report().device_use;
    const bool keyframe = slam.feed(frame).keyframe;
    if (i >= kFirstCounted)
      (keyframe ? use.keyframes : use.tracked).add(slam.engine_report().device_use - before);
    progress.show(static_cast<double>(i + 1) / kFrames, "counting");
  }
  return use;
}

}  // namespace surefield
