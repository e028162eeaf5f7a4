#pragma once

#include <memory>
#include <vector>

#include "engine/io/trajectory_file.h"
#include "engine/slam/settings.h"
#include "engine/types/frame.h"
#include "engine/types/trajectory.h"

namespace surefield {

/// What happened to one frame.
struct FrameReport {
  int index = 0;         ///< Frame::index
  double timestamp = 0;  ///< seconds
  Pose world_to_camera = Pose::Identity();
  bool keyframe = false;
  bool lost = false;  ///< tracking failed even after the re-tries; the pose is the best found
  int retries = 0;    ///< other starting poses that were tried
  double tracking_loss = 0;
  double valid_fraction = 0;  ///< pixels that took part in tracking, of those with sensor depth
  int tracking_iterations = 0;
  double tracking_ms = 0;
  int mapping_iterations = 0;
  double mapping_ms = 0;
  uint32_t gaussians = 0;            ///< in the map after this frame
  uint32_t uncertain_gaussians = 0;  ///< on the device when the frame's mapping judged them
  uint32_t device_gaussians = 0;     ///< of these, on the device
  uint64_t device_bytes = 0;         ///< device memory in use after this frame
};

/// RGB-D SLAM (the paper's system): feed frames in order, get poses and the map.
///
///   Slam slam(settings, intrinsics);
///   while (auto frame = stream.next()) slam.feed(*frame);
///   slam.finish();
///   write_trajectory("trajectory.txt", slam.trajectory());
///   write_ply("map.ply", slam.map());
class Slam {
 public:
  /// `intrinsics` are those of the frames that will be fed. Throws gpu::Error when no device is usable, and
  /// InputError where a file that the settings name cannot be used.
  Slam(const SlamSettings& settings, const Intrinsics& intrinsics, const EngineOptions& options = {});
  ~Slam();

  /// Tracks the frame and, if it becomes a keyframe, extends and optimises the map. Throws
  /// std::invalid_argument when the images do not have the size of the intrinsics. A frame that cannot be
  /// used throws and changes nothing.
  const FrameReport& feed(const Frame& frame);

  /// Call after the last frame: unless it is a keyframe, it becomes one, so that the map shows all that was
  /// seen.
  void finish();

  /// From the next frame on, takes the settings of tracking, mapping, spawning, densification and the loss of
  /// tracking, the mapping steps per keyframe, and when a frame becomes a keyframe; all others stay as they
  /// were at the beginning.
  void change(const SlamSettings& settings);

  /// Poses of all frames so far, camera to world, in the first camera's frame. Keyframes have their refined
  /// poses, and the frames between follow the keyframe that they were tracked after.
  Trajectory trajectory() const;
  /// The keyframes alone.
  Trajectory keyframes() const;
  /// Those that were optimised together last: positions in keyframes(), the newest last.
  const std::vector<int>& window() const;
  /// The Gaussian map.
  GaussianCloud map() const;
  /// Renders the map; world frame as in trajectory().
  RenderImages render(const Camera& camera) const;

  const std::vector<FrameReport>& reports() const;
  EngineReport engine_report() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace surefield
