#pragma once

#include <vector>

#include "engine/slam/slam.h"
#include "engine/synth/synthetic_recording.h"
#include "tests/support/device.h"

namespace surefield::testing {

/// The engine on the device of the tests, with validation.
inline EngineOptions engine_options() {
  return {.device = device_options().selector, .validate = true};
}

/// The synthetic office in small images.
inline SyntheticRecording office(int frames) {
  return SyntheticRecording(device_options(), {.width = 96, .height = 72, .frames = frames});
}

/// Settings of few steps, with which every third frame becomes a keyframe.
inline SlamSettings quick_settings() {
  SlamSettings settings;
  settings.sensor = DepthSensor::Perfect;
  settings.first_iterations = 40;
  settings.mapping_iterations = 10;
  settings.tracking.adam.first_iterations = 25;
  settings.keyframes.interval = 3;
  return settings;
}

/// The first so many frames of the office, loaded once.
inline const std::vector<Frame>& office_frames() {
  static const std::vector<Frame> frames = [] {
    const SyntheticRecording dataset = office(8);
    std::vector<Frame> loaded;
    for (int i = 0; i < dataset.count(); ++i) loaded.push_back(*dataset.load(i).frame);
    return loaded;
  }();
  return frames;
}

/// The camera of those.
inline Intrinsics office_camera() {
  static const Intrinsics intrinsics = office(1).intrinsics();
  return intrinsics;
}

/// Whether two runs have given the same bits: the poses of all frames and the map.
inline bool same_results(const Slam& a, const Slam& b) {
  const Trajectory one = a.trajectory(), other = b.trajectory();
  bool same = one.size() == other.size();
  for (std::size_t i = 0; same && i < one.size(); ++i)
    same = one[i].timestamp == other[i].timestamp &&
           one[i].camera_to_world.matrix() == other[i].camera_to_world.matrix();
  const GaussianCloud map = a.map(), other_map = b.map();
  return same && map.means == other_map.means && map.log_scales == other_map.log_scales &&
         map.opacity_logits == other_map.opacity_logits && map.sh == other_map.sh;
}

}  // namespace surefield::testing
