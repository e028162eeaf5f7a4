#pragma once

#include <atomic>
#include <exception>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "engine/slam/camera_tracker.h"
#include "engine/slam/fair_mutex.h"
#include "engine/slam/first_light.h"
#include "engine/slam/frame_history.h"
#include "engine/slam/held_frame.h"
#include "engine/slam/keyframe_graph.h"
#include "engine/slam/loop_closer.h"
#include "engine/slam/map_upkeep.h"
#include "engine/slam/slam.h"

namespace surefield {

/// What a frame that may become a keyframe needs beside its images and its pose; `image` has the exposure of
/// the map.
struct Sighting {
  HeldFrame image;
  std::vector<Eigen::Vector3f> points;  ///< sample_points()
  Eigen::VectorXf descriptor;           ///< of a keyframe; empty where images are not described
  ColourGrid grid;                      ///< of the image as the camera took it
  PlacedFeatures features;              ///< of a keyframe
};

/// The last frame fed, which is no keyframe: finish() may make it one.
struct PendingFrame {
  Frame frame;  ///< with images of its own
  Sighting sighting;
};

/// The parts of a run, and the steps that lead a frame through them: slam.cpp has their order,
/// slam_implementation.cpp what they do, slam_corrections.cpp what later frames put right.
struct Slam::Implementation {
  std::stop_source stop;  ///< of mapping; from any thread
  SlamSettings settings;
  Intrinsics intrinsics;
  KeyframeGraph keyframes;
  SplatEngine engine;
  FrameHistory history;
  CameraTracker tracker;
  MapUpkeep upkeep;
  LoopCloser loops;
  FirstLight first_light;
  Eigen::Vector3f map_gains = Eigen::Vector3f::Ones();  ///< times these the map's colours are shown
  std::optional<Frame>
      first_frame;  ///< until it is known how the camera moved between its depth and its colour
  std::optional<PendingFrame> pending;
  bool finished = false;
  std::optional<std::string> broken;  ///< by what mapping ended in the middle
  uint64_t revision = 0;
  RevisionListener listener;

  FairMutex turns;                       ///< held by the thread that feeds, finishes or changes
  std::atomic<std::thread::id> at_turn;  ///< that thread
  FairMutex state;  ///< guards all of the above; held by who reads, and by the thread at turn except while a
                    ///< function of the caller runs

  Implementation(const SlamSettings& s, const Intrinsics& k, const EngineOptions& options,
                 std::unique_ptr<ImageDescriptor> descriptor);

  /// Throws StateError where no frame may be fed or made a keyframe any more.
  void check_usable() const;
  /// Throws UsageError where the images are not of the size and type that the intrinsics ask for.
  void check_images(const Frame& frame) const;

  // Before mapping: these change nothing that a caller sees.

  /// The frame without depth that is not finite, not positive, or beyond depth_max: 0 in its place. Throws
  /// InputError where that leaves the first frame none.
  Frame within_reach(const Frame& frame) const;
  /// Its coarse picture. Throws NoImageError where the image shows nothing, or the exposure has yet to
  /// settle.
  ColourGrid look(const Frame& frame);
  /// The first frame: it stands at the origin and becomes a keyframe.
  Sighting sight_first(const Frame& frame, ColourGrid grid, FrameReport& report);
  /// Any other: predicts its pose, brings it to the exposure of the map, tracks it and decides whether it
  /// becomes a keyframe.
  Sighting sight(const Frame& frame, ColourGrid grid, FrameReport& report);
  /// Finds a frame in the whole map.
  FrameReport locate(const Frame& frame);
  HeldFrame hold(const Frame& frame, const Eigen::Vector3f& gains, const Pose& predicted);
  /// A frame with its colours times these gains, and what was saturated as bright as the map shows it from
  /// `pose`.
  Frame expose(const Frame& frame, const Eigen::Vector3f& gains, const Pose& pose) const;
  bool wants_keyframe(const FrameReport& report) const;

  // Mapping, of the last frame of the history.

  /// Runs `mapping`; where that throws, SLAM is broken. `told` says whether the newest keyframe's pose has
  /// been returned by an earlier call.
  template <typename Mapping>
  void change_map(bool told, Mapping mapping) {
    try {
      mapping();
    } catch (...) {
      note_break();
      note_moves(told);
      throw;
    }
    note_moves(told);
  }
  void begin_map(const Frame& frame, Sighting sighting);
  void map_first(const Frame& frame);
  /// Whether the second frame shows that the camera moved noticeably between the first one's depth and colour
  /// image.
  bool shows_depth_moved(const FrameReport& second) const;
  CameraMotion motion_from_first(const FrameReport& second) const;
  /// Begins the map again, with the first frame's depth where the camera was when its colour was taken.
  void begin_again(const FrameReport& second);
  void extend_map(const Frame& frame, Sighting sighting);
  void map_keyframe(const Frame& frame, Sighting sighting);
  Frame add_keyframe(const Frame& frame, Sighting sighting);
  /// Closes a loop where the newest keyframe, which is mapped, has come back to a place; both visits are
  /// mapped together then.
  void close_loop();
  /// Takes what moves out of the newest keyframe, whose images `mapped` are, and out of those that were last
  /// optimised together, where the one looks through what the other shows.
  void hide_moved(Frame& mapped);
  /// A camera that fades in begins with images that are much darker than all others. Where the newest
  /// keyframe shows all before it to be, they, and the map, are brought to its exposure, which the map shall
  /// have from here on.
  void brighten_dim();
  std::vector<uint8_t> hide(int k, const std::vector<uint8_t>& cells);
  void measure();
  /// Gives the map the exposure that most frames have.
  void settle_exposure();
  void note_break();
  void note_moves(bool told);
};

}  // namespace surefield
