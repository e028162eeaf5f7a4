#include "tools/results/run_scene.h"

#include <algorithm>
#include <map>

#include "engine/eval/trajectory_metrics.h"
#include "engine/session/loop_table.h"
#include "engine/sources/frame_stream.h"
#include "engine/types/error.h"

namespace surefield {

namespace {

Intrinsics guessed_intrinsics(const RunFolder& run) {
  const double width = run.number("/dataset/width"), height = run.number("/dataset/height");
  return {.width = static_cast<int>(width),
          .height = static_cast<int>(height),
          .fx = width,
          .fy = width,
          .cx = (width - 1) / 2,
          .cy = (height - 1) / 2};
}

/// The true poses of the tracked camera during the run, in the world of the estimate; empty where they are
/// not known.
Trajectory truth_of(const RunFolder& run, const Dataset& dataset) {
  if (!dataset.ground_truth || run.trajectory.empty()) return {};
  Trajectory truth;
  try {
    const Pose to_estimate = evaluate_trajectory(run.trajectory, *dataset.ground_truth).alignment.inverse();
    for (const StampedPose& pose : *dataset.ground_truth)
      if (pose.is_finite() && (truth.empty() || pose.timestamp > truth.back().timestamp) &&
          pose.timestamp >= run.trajectory.front().timestamp &&
          pose.timestamp <= run.trajectory.back().timestamp)
        truth.push_back({pose.timestamp, to_estimate * pose.camera_to_world});
  } catch (const InputError&) {
    return {};  // too few poses to compare
  }
  return of_tracked_camera(std::move(truth), *dataset.recording);
}

}  // namespace

std::optional<SceneFrame> RunScene::load_frame(int position) const {
  const LoadedFrame loaded = dataset->recording->load(run.metrics["per_frame"][position].value("index", 0));
  if (!loaded.frame) return std::nullopt;
  const Frame frame = resize_frame(*loaded.frame, run.number("/dataset/scale"));
  return SceneFrame{position,
                    {scene.frame.camera.intrinsics, scene.trajectory[position].camera_to_world.inverse()},
                    frame.colour,
                    frame.depth};
}

/// The keyframes that are known to see one place, by their positions among all.
std::vector<std::pair<int, int>> loops_of(const RunFolder& run) {
  std::vector<std::pair<int, int>> links;
  const std::filesystem::path file = run.path / "loops.csv";
  if (!std::filesystem::exists(file)) return links;
  std::map<int, double> stamps;  // of frames, which keyframes are among
  for (std::size_t i = 0; i < run.trajectory.size(); ++i)
    stamps[run.metrics["per_frame"][i].value("index", -1)] = run.trajectory[i].timestamp;
  const auto keyframe_of = [&](int frame) {
    const auto found =
        std::find_if(run.keyframes.begin(), run.keyframes.end(), [&](const StampedPose& keyframe) {
          return stamps.contains(frame) && keyframe.timestamp == stamps[frame];
        });
    return found == run.keyframes.end() ? -1 : static_cast<int>(found - run.keyframes.begin());
  };
  for (const StoredLoop& loop : read_loops(file))
    if (loop.accepted) links.emplace_back(keyframe_of(loop.measured.from), keyframe_of(loop.measured.to));
  return links;
}

RunScene read_run_scene(const std::filesystem::path& folder, const std::string& dataset) {
  RunScene result;
  result.run = read_run(folder);
  ViewerScene& scene = result.scene;
  scene.loops = loops_of(result.run);
  try {
    result.dataset = open_dataset_of(result.run, dataset);
  } catch (const InputError& problem) {
    if (!dataset.empty()) throw;
    result.missing = problem.what();
    scene.trajectory = result.run.trajectory;
    scene.keyframes = result.run.keyframes;
    scene.frame.camera.intrinsics = guessed_intrinsics(result.run);
    return result;
  }
  const Recording& recording = *result.dataset->recording;
  const auto views = views_of(result.run, recording);  // checks that the dataset is the run's
  scene.trajectory = of_tracked_camera(result.run.trajectory, recording);
  scene.keyframes = of_tracked_camera(result.run.keyframes, recording);
  scene.truth = truth_of(result.run, *result.dataset);
  scene.frame.camera.intrinsics = recording.intrinsics().scaled(result.run.number("/dataset/scale"));
  return result;
}

}  // namespace surefield
