#include "tools/eval/eval_loops.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/eval/loop_metrics.h"
#include "engine/eval/pose_track.h"
#include "engine/io/files.h"
#include "engine/session/loop_table.h"
#include "engine/types/error.h"
#include "tools/results/run_folder.h"
#include "tools/shared/command.h"
#include "tools/shared/interrupt.h"
#include "tools/shared/progress.h"

namespace surefield {

namespace {

constexpr double kDepthWidth = 160;  // pixels; more tell no more about what is seen

/// The keyframes of a run whose true poses are known.
struct TrueKeyframes {
  std::vector<int> frames;  ///< their indices
  std::vector<PlaceView> views;
  int unknown = 0;  ///< keyframes without a true pose, or that cannot be read
};

TrueKeyframes true_keyframes(const RunFolder& run, const Dataset& dataset) {
  const Recording& recording = *dataset.recording;
  if (!dataset.ground_truth)
    throw InputError(recording.name(), "has no true poses, without which nobody knows what is seen again");
  const PoseTrack track(of_tracked_camera(*dataset.ground_truth, recording));
  const double scale = std::min(1.0, kDepthWidth / recording.intrinsics().width);
  const auto frame_of = frames_of(recording, scale);
  TrueKeyframes keyframes;
  const nlohmann::json& frames = run.metrics["per_frame"];
  CountProgress progress("frames", static_cast<int>(frames.size()));
  for (std::size_t i = 0; i < frames.size() && !interrupted(); ++i) {
    progress.reached(static_cast<int>(i) + 1);
    if (!frames[i].value("keyframe", nlohmann::json(false)).get<bool>()) continue;
    const int index = frames[i].at("index").get<int>();
    const auto frame = frame_of(index);
    const auto pose = track.at(run.trajectory[i].timestamp);
    if (!frame || !pose) {
      ++keyframes.unknown;
      continue;
    }
    keyframes.frames.push_back(index);
    keyframes.views.push_back({{recording.intrinsics().scaled(scale), pose->inverse()}, frame->depth});
  }
  return keyframes;
}

/// The accepted loops between keyframes whose true poses are known.
std::vector<LoopEdge> accepted_edges(const std::vector<StoredLoop>& loops, const TrueKeyframes& keyframes) {
  const auto position = [&](int frame) {
    const auto found = std::find(keyframes.frames.begin(), keyframes.frames.end(), frame);
    return found == keyframes.frames.end() ? -1 : static_cast<int>(found - keyframes.frames.begin());
  };
  std::vector<LoopEdge> edges;
  for (const StoredLoop& loop : loops) {
    const LoopEdge edge{position(loop.measured.from), position(loop.measured.to), loop.measured.pose};
    if (loop.accepted && edge.from >= 0 && edge.to >= 0) edges.push_back(edge);
  }
  return edges;
}

nlohmann::ordered_json to_json(const LoopMetrics& metrics, const TrueKeyframes& keyframes, int unjudged) {
  nlohmann::ordered_json json = {{"schema", "surefield-loops"}, {"version", 1}};
  json["keyframes"] = keyframes.views.size();
  json["revisits"] = metrics.revisits.size();
  json["closed"] = metrics.closed;
  json["accepted"] = metrics.edges;
  json["right"] = metrics.right;
  json["false"] = metrics.wrong;
  json["unjudged"] = unjudged;
  json["largest_error_m"] = metrics.largest;
  json["per_revisit"] = nlohmann::ordered_json::array();
  for (const Revisit& revisit : metrics.revisits)
    json["per_revisit"].push_back({{"first_frame", keyframes.frames[revisit.first]},
                                   {"last_frame", keyframes.frames[revisit.last]},
                                   {"closed", revisit.closed}});
  return json;
}

void print_loops(const LoopMetrics& metrics, const TrueKeyframes& keyframes, int unjudged) {
  fmt::print("keyframes        {}", keyframes.views.size());
  if (keyframes.unknown > 0) fmt::print(", {} more without a true pose", keyframes.unknown);
  fmt::print("\nrevisits         {}, {} closed\n", metrics.revisits.size(), metrics.closed);
  for (const Revisit& revisit : metrics.revisits)
    fmt::print("  frames {:>6} to {:>6}   {}\n", keyframes.frames[revisit.first],
               keyframes.frames[revisit.last], revisit.closed ? "closed" : "open");
  fmt::print("accepted edges   {}, {} right, {} false", metrics.edges, metrics.right, metrics.wrong);
  if (unjudged > 0) fmt::print(", and {} of keyframes without a true pose", unjudged);
  if (metrics.edges > 0) fmt::print(" (the largest error {:.1f} cm)", 100 * metrics.largest);
  fmt::print("\n");
}

}  // namespace

CLI::Option* add_loop_options(CLI::App& eval, EvalLoopsOptions& options) {
  return eval.add_option("--loops", options.run,
                         "Folder of results with loops.csv: which revisits were closed, and which loops are "
                         "false");
}

int evaluate_loops(const EvalLoopsOptions& options) {
  catch_interrupts();
  const RunFolder run = read_run(options.run);
  const std::vector<StoredLoop> loops = read_loops(run.path / "loops.csv");
  const TrueKeyframes keyframes = true_keyframes(run, open_dataset_of(run, options.dataset));
  if (interrupted()) return kInterrupted;
  const std::vector<LoopEdge> edges = accepted_edges(loops, keyframes);
  const auto accepted =
      std::count_if(loops.begin(), loops.end(), [](const StoredLoop& loop) { return loop.accepted; });
  const int unjudged = static_cast<int>(accepted) - static_cast<int>(edges.size());
  const LoopMetrics metrics = measure_loops(keyframes.views, edges);
  print_loops(metrics, keyframes, unjudged);
  if (!options.json.empty()) {
    const auto json = to_json(metrics, keyframes, unjudged);
    write_file(options.json, [&](std::ostream& stream) { stream << json.dump(2) << "\n"; });
  }
  return kSuccess;
}

}  // namespace surefield
