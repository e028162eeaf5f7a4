#include "engine/sources/frame_source.h"

namespace surefield {

Trajectory of_reference_camera(Trajectory tracked, const FrameSource& source) {
  const Pose reference_to_tracked = source.tracked_to_reference().inverse();
  for (StampedPose& pose : tracked) pose.camera_to_world = pose.camera_to_world * reference_to_tracked;
  return tracked;
}

Trajectory of_tracked_camera(Trajectory reference, const FrameSource& source) {
  const Pose tracked_to_reference = source.tracked_to_reference();
  for (StampedPose& pose : reference) pose.camera_to_world = pose.camera_to_world * tracked_to_reference;
  return reference;
}

}  // namespace surefield
