#pragma once

#include <atomic>
#include <exception>
#include <optional>
#include <string>
#include <thread>

#include "engine/slam/camera_tracker.h"
#include "engine/slam/fair_mutex.h"
#include "engine/slam/frame_history.h"
#include "engine/slam/held_frame.h"
#include "engine/slam/keyframe_graph.h"
#include "engine/slam/map_upkeep.h"
#include "engine/slam/slam.h"

namespace surefield {

/// What a frame that may become a keyframe needs beside its images and its pose.
struct Sighting {
  HeldFrame image;
  std::vector<Eigen::Vector3f> points;  ///< sample_points()
  Eigen::VectorXf descriptor;           ///< of a keyframe; empty where images are not described
};

/// The last frame fed, which is no keyframe: finish() may make it one.
struct PendingFrame {
  Frame frame;  ///< with images of its own
  Sighting sighting;
};

/// The parts of a run, and the steps that lead a frame through them: slam.cpp has their order,
/// slam_implementation.cpp what they do.
struct Slam::Implementation {
  SlamSettings settings;
  Intrinsics intrinsics;
  KeyframeGraph keyframes;
  SplatEngine engine;
  FrameHistory history;
  CameraTracker tracker;
  MapUpkeep upkeep;
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

  /// The first frame: it stands at the origin and becomes a keyframe.
  Sighting sight_first(const Frame& frame, FrameReport& report);
  /// Any other: predicts its pose, tracks it and decides whether it becomes a keyframe.
  Sighting sight(const Frame& frame, FrameReport& report);
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
  void extend_map(const Frame& frame, Sighting sighting);
  void map_keyframe(const Frame& frame, Sighting sighting);
  void add_keyframe(const Frame& frame, Sighting sighting);
  void measure();
  void note_break();
  void note_moves(bool told);
};

}  // namespace surefield
