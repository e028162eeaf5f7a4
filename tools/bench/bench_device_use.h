#pragma once

#include <string>

#include "engine/gpu/device_counters.h"

namespace surefield {

/// What frames of one kind ask of the device.
struct FrameUse {
  int frames = 0;             ///< that were counted
  gpu::DeviceCounters total;  ///< of all of them
  gpu::DeviceCounters most;   ///< figure by figure, of the one that asked for the most of it

  void add(const gpu::DeviceCounters& frame);
};

/// What a SLAM run asks of the device, frame by frame, once it has all the memory that frames need: a run
/// over the first frames of the synthetic office, of which the last are counted.
struct DeviceUse {
  int frames = 0;  ///< of the run
  int width = 0;   ///< pixels, as the next
  int height = 0;
  FrameUse tracked;    ///< frames that were tracked and no more
  FrameUse keyframes;  ///< frames that were tracked and mapped
};

/// Counts on the device of that index or part of a name; empty: the best there is. Throws gpu::Error.
DeviceUse measure_device_use(const std::string& device);

}  // namespace surefield
