#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "engine/places/image_descriptor.h"
#include "engine/slam/frame_report.h"
#include "engine/slam/loop.h"
#include "engine/slam/settings.h"
#include "engine/types/gaussian_cloud.h"
#include "engine/types/render_images.h"
#include "engine/types/trajectory.h"

namespace surefield {

struct Frame;

/// RGB-D SLAM (the paper's system): feed frames in order, get poses and the map.
///
///   Slam slam(settings, intrinsics);
///   while (auto frame = stream.next()) slam.feed(*frame);
///   slam.finish();
///   write_trajectory("trajectory.txt", slam.trajectory());
///   write_map("map.ply", slam.map());
///
/// SlamThread (slam_thread.h) feeds without waiting for the map.
///
/// Threads: every method may be called from any thread. feed(), locate(), finish(), change() and
/// on_revision() take turns; stop_mapping() does not wait. All others only read; they wait for a frame in
/// work and are let in, in the order in which they ask, between frames and while feed() or finish() runs a
/// function of the caller. What is returned is a copy.
///
/// Errors: what derives from Error (engine/types/error.h), or std::bad_alloc. Where feed() or finish() throws
/// before mapping has begun, nothing has changed: the frame was not fed, and the next may be. Where mapping
/// itself throws, the map is left half done: usable() is false from there on, feed() and finish() throw a
/// StateError that names the cause, and the reading methods tell what there is, as far as the device works.
class Slam {
 public:
  /// Is told a frame's pose when it is known, before the map is worked on: the report lacks what mapping will
  /// add, and mapping may refine the pose. Called by the thread that feeds; may read from the Slam, which has
  /// the frame already, but neither feed, finish nor change it. What it throws is thrown by feed(), before
  /// mapping.
  using Tracked = std::function<void(const FrameReport&)>;
  /// Is told the revision() when it has changed.
  using RevisionListener = std::function<void(uint64_t)>;

  /// `settings` are in the ranges that SlamSettings::bind() gives their keys, `intrinsics` those of the
  /// frames that will be fed. Keyframes that look alike are found by `descriptor`, instead of by what
  /// settings.keyframes.covisibility asks for, unless it is null; it is called by the thread that feeds, may
  /// not call the Slam, and where it throws the frame changes nothing. Throws gpu::Error when no device is
  /// usable, and InputError where a file that the settings name cannot be used.
  Slam(const SlamSettings& settings, const Intrinsics& intrinsics, const EngineOptions& options = {},
       std::unique_ptr<ImageDescriptor> descriptor = nullptr);
  ~Slam();

  /// Tracks the frame and, if it becomes a keyframe, extends and optimises the map. The images are copied
  /// where they are needed later. Throws UsageError where they do not have the size and type that the
  /// intrinsics ask for, InputError where the first frame has no valid depth, NoImageError where an image
  /// shows nothing (all black or white) or, in the first second after such images at the beginning, the
  /// camera's exposure has yet to settle: frames to pass over. Throws StateError where no frame may be fed
  /// any more, and gpu::Error; see above for what has changed then.
  FrameReport feed(const Frame& frame, const Tracked& tracked = {});

  /// Finds where a frame was taken by what the whole map shows, from nothing but the frame, wherever the
  /// camera was before: for a device that is switched on in a place that is mapped, also after finish().
  /// Changes neither map nor trajectory. The report's pose is world to camera; it is lost() where no place is
  /// certain. Throws as feed() does, and StateError where there is no map yet.
  FrameReport locate(const Frame& frame);

  /// Call after the last frame: unless it is a keyframe, or its pose is not good, it becomes one, so that the
  /// map shows all that was seen. If the light has changed, the map is given the exposure that most frames
  /// have. No frame may be fed after it; calling it again does nothing.
  void finish();

  /// From now on mapping steps that remain are left out, those of a frame in work too, so that it ends soon:
  /// for a run that has to end. Poses and map are what they are then. Waits for nothing.
  void stop_mapping();

  /// Whether frames may be fed: until finish(), or an error in the middle of mapping.
  bool usable() const;

  /// From the next frame on, takes the settings of tracking, mapping, spawning, densification, light and the
  /// loss of tracking, the mapping steps per keyframe and the time that a frame has, and when a frame becomes
  /// a keyframe; all others stay as they were at the beginning.
  void change(const SlamSettings& settings);

  /// Poses of all frames so far, camera to world, in the first camera's frame. Keyframes have their refined
  /// poses, and the frames between follow the keyframe that they were tracked after.
  Trajectory trajectory() const;
  /// The same as they were when each frame came: of what later frames have corrected, nothing.
  Trajectory online_trajectory() const;
  /// The keyframes alone.
  Trajectory keyframes() const;
  /// Those that were optimised together last: positions in keyframes(), the newest last.
  std::vector<int> window() const;
  /// The places that looked known, with what came of it: in the order of the newer of the two keyframes,
  /// which are positions in keyframes().
  std::vector<Loop> loops() const;
  /// The Gaussian map.
  GaussianCloud map() const;
  /// Renders the map; world frame as in trajectory().
  RenderImages render(const Camera& camera) const;

  /// How often poses in trajectory() have become others than those that feed() had returned for their frames:
  /// by at most one for a call of feed() or finish(), where it refined earlier keyframes.
  uint64_t revision() const;
  /// Sets who is told so: at the end of such a call of feed() or finish(), by the thread that calls it. It
  /// may read from the Slam, but neither feed, finish nor change it, and must not throw.
  void on_revision(RevisionListener listener);

  /// One for each frame fed.
  std::vector<FrameReport> reports() const;
  EngineReport engine_report() const;

 private:
  struct Implementation;
  class Turn;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace surefield
