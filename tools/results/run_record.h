#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/eval/depth_delay.h"
#include "engine/eval/trajectory_metrics.h"
#include "engine/session/run_sequence.h"
#include "engine/slam/slam.h"
#include "engine/sources/frame_stream.h"
#include "engine/viewer/up_direction.h"
#include "tools/results/map_quality.h"
#include "tools/results/trajectory_report.h"

namespace surefield {

inline constexpr double kMegabyte = 1e6;  ///< bytes

/// How long frames took, milliseconds: half of them at most `median`, 95 of 100 at most `most`.
struct Latency {
  double median = 0;
  double most = 0;
};

/// What a live source, or a replay at its own speed, has come to.
struct LiveRecord {
  LiveCounts counts;
  std::optional<Latency> from_arrival;  ///< until the pose was known; nullopt where no frame has one
  std::optional<Latency> from_stamp;    ///< the same from the stamp, where that is of this machine's clock
};

/// Everything that is known about a run when it has ended.
struct RunRecord {
  std::optional<RunEnd> end;  ///< nullopt: it is still running
  std::string error;          ///< why it failed
  std::string dataset;
  std::string dataset_path;  ///< where it was read from, absolute; or "synthetic"; empty of a live source
  std::string format;
  double depth_delay = 0;                           ///< seconds, added to the stamps of depth images
  std::optional<DepthDelay> estimated_depth_delay;  ///< where depth_delay comes from
  std::string assumed_camera;                       ///< as the user asked; empty: none
  std::optional<double> assumed_depth_unit;         ///< metres, as the user asked
  std::string colour_topic;                         ///< of a log, as the user asked; empty: chosen
  std::string depth_topic;                          ///< the same of depth
  FrameSelection selection;
  std::optional<int> selected;  ///< frames that were to be fed; nullopt: nobody knew how many
  Intrinsics intrinsics;        ///< of the frames fed
  double depth_max = 0;         ///< metres; 0: none
  DepthNoise noise;             ///< of the sensor
  std::vector<SkippedFrame> skipped;
  std::vector<FrameReport> frames;  ///< those fed
  Trajectory trajectory;            ///< one pose per frame fed, of the tracked camera
  Trajectory online;                ///< the same, as they were when each frame came
  Trajectory keyframes;             ///< of the tracked camera
  std::vector<Loop> loops;          ///< places that looked known
  std::optional<LiveRecord> live;   ///< nullopt where no frame could be dropped
  double setup_seconds = 0;         ///< opening the device, building its programs
  double seconds = 0;               ///< from the first frame asked for to the last one done
  EngineReport engine;
  RunAccuracy accuracy;
  std::optional<MapQuality> images;
  std::optional<UpDirection> up;  ///< in the world of the trajectory, once the run has ended

  /// Frames whose pose is known, of all that were read; nan: none was.
  double pose_share() const;
  /// Frames at the end of the run whose poses are poor or not known.
  int doubtful_end() const;
  /// Gaussians in the final map.
  uint32_t gaussians() const { return frames.empty() ? 0 : frames.back().gaussians; }
  double frames_per_second() const { return seconds > 0 ? static_cast<double>(frames.size()) / seconds : 0; }
};

/// Iterations of one kind over a whole run.
struct IterationTotal {
  int iterations = 0;
  double seconds = 0;

  double milliseconds_each() const { return iterations > 0 ? 1000 * seconds / iterations : 0; }
};

/// All tracking, or all mapping, of a run.
IterationTotal tracking_total(const std::vector<FrameReport>& frames);
IterationTotal mapping_total(const std::vector<FrameReport>& frames);

/// Number of frames for which `test` holds.
template <typename Test>
int count_frames(const std::vector<FrameReport>& frames, Test test) {
  int count = 0;
  for (const FrameReport& frame : frames) count += test(frame) ? 1 : 0;
  return count;
}

/// Loops that were taken for true.
int count_loops(const std::vector<Loop>& loops);

/// metrics.json, as docs/evaluation.md describes it; `files` is that of run_files_json().
std::string metrics_json(const RunRecord& record, const nlohmann::ordered_json& files);

/// The lines that the user reads at the end of a run.
std::string run_summary(const RunRecord& record);

}  // namespace surefield
