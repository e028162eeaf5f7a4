#include "tools/run/run_session.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>

#include "engine/io/files.h"
#include "engine/session/kept_keyframes.h"
#include "engine/session/results_folder.h"
#include "engine/session/run_log.h"
#include "engine/session/run_sequence.h"
#include "engine/session/save_run.h"
#include "engine/types/build_info.h"
#include "engine/types/error.h"
#include "engine/types/version.h"
#include "tools/results/map_quality.h"
#include "tools/results/run_record.h"
#include "tools/shared/command.h"
#include "tools/shared/interrupt.h"
#include "tools/shared/progress.h"

namespace surefield {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostCompared = 60;  // frames whose images are compared; surefield eval --run takes all

void write_text(const std::filesystem::path& file, const std::string& text) {
  write_file(file, [&](std::ostream& stream) { stream << text; });
}

std::optional<TrajectoryMetrics> accuracy(const Trajectory& estimate, const Trajectory* truth) {
  if (!truth) return std::nullopt;
  try {
    return evaluate_trajectory(estimate, *truth);
  } catch (const InputError&) {
    return std::nullopt;  // too few poses to compare
  }
}

/// What the source of the frames says about a run before it starts.
RunRecord start_record(const RunOptions& options, const FrameSource& source) {
  RunRecord record;
  record.dataset = source.name();
  record.dataset_path = dataset_path(options);
  record.format = source.format();
  record.depth_delay = options.depth_delay.value_or(0);
  record.selection = options.selection;
  record.selected = source.size();
  record.intrinsics = source.intrinsics();
  return record;
}

/// Runs the sequence with all that watch it; `record` learns how it went. Returns why it failed, or null.
std::exception_ptr run(RunRecord& record, FrameSource& source, Slam& slam, spdlog::logger& log,
                       RunObservers observers, bool quiet) {
  RunLog lines(log);
  Progress progress(source.size(), quiet);
  observers.insert(observers.begin(), {&lines, &progress});
  const SequenceRun run = run_sequence(source, slam, observers, interrupted);
  record.end = run.end;
  record.seconds = run.seconds;
  record.skipped = run.skipped;
  if (run.failure) {
    record.error = describe(run.failure);
    log.error(record.error);
  }
  return run.failure;
}

/// Adds what SLAM and the ground truth, which may be null, say about a run that has ended.
void complete_record(RunRecord& record, const Slam& slam, const FrameSource& source,
                     const Trajectory* truth) {
  record.frames = slam.reports();
  record.trajectory = slam.trajectory();
  record.keyframes = slam.keyframes();
  record.engine = slam.engine_report();
  record.accuracy = accuracy(of_reference_camera(record.trajectory, source), truth);
  record.keyframe_accuracy = accuracy(of_reference_camera(record.keyframes, source), truth);
}

/// The frames that the final map is compared with, by their places among those fed: all, or kMostCompared
/// evenly spaced ones where there are more; the kept keyframes where the source cannot be read again.
std::vector<std::size_t> compared_frames(const RunRecord& record, const FrameSource& source,
                                         const KeptKeyframes& kept) {
  std::vector<std::size_t> places;
  const std::size_t fed = record.frames.size();
  if (source.recording()) {
    const std::size_t count = std::min(fed, kMostCompared);
    for (std::size_t k = 0; k < count; ++k) places.push_back(count < 2 ? 0 : k * (fed - 1) / (count - 1));
  } else {
    for (std::size_t i = 0; i < fed; ++i)
      if (kept.find(record.frames[i].index)) places.push_back(i);
  }
  return places;
}

/// Compares the final map with compared_frames().
std::optional<MapQuality> measure_images(const RunRecord& record, const Slam& slam, const FrameSource& source,
                                         const KeptKeyframes& kept) {
  QualityInput input{
      .frame = {}, .views = {}, .depth_max = record.depth_max, .render = [&](const Camera& camera) {
        return slam.render(camera);
      }};
  if (source.recording()) {
    input.frame = frames_of(*source.recording(), record.selection.scale);
  } else {
    input.frame = [&](int index) {
      const Frame* frame = kept.find(index);
      return frame ? std::optional(*frame) : std::nullopt;
    };
  }
  for (std::size_t i : compared_frames(record, source, kept))
    input.views.push_back({record.frames[i].index,
                           {record.intrinsics, record.trajectory[i].camera_to_world.inverse()},
                           record.frames[i].keyframe});
  return measure_map_quality(input);
}

void save_results(ResultsFolder& results, RunRecord& record, const Slam& slam, const FrameSource& source,
                  const KeptKeyframes& kept, const std::string& map_format) {
  save_run(results, slam, source, map_format);
  if (record.end == RunEnd::Completed) {
    results.save("the image quality",
                 [&](const auto&) { record.images = measure_images(record, slam, source, kept); });
  }
  results.save("metrics.json", [&](const auto& file) { write_text(file, metrics_json(record)); });
}

/// Tells the log, and unless `quiet` the user, how the run went.
void report(ResultsFolder& results, const RunRecord& record, bool quiet) {
  for (const std::string& message : record.engine.validation_messages) {
    results.log().error("validation: {}", message);
    fmt::print(stderr, "surefield: validation: {}\n", message);
  }
  const std::string summary = run_summary(record);
  results.log().info("summary\n{}", summary);
  if (!quiet) fmt::print("{}results          {}\n", summary, results.path().string());
  std::fflush(stdout);
}

/// Tells the log what runs on what, and unless `quiet` the user what to know about the source.
void announce(spdlog::logger& log, const RunRecord& record, const FrameSource& source, const Slam& slam,
              bool quiet) {
  const EngineReport engine = slam.engine_report();
  log.info("surefield {} ({}) on {}, {}", kVersion, kGitCommit, engine.device, engine.driver);
  log.info("{} ({}): {} frames of {} x {}", record.dataset, record.format,
           record.selected ? std::to_string(*record.selected) : "no known number of", record.intrinsics.width,
           record.intrinsics.height);
  if (!source.recording())
    log.info("its frames cannot be read again: the final map is compared with up to {} keyframes",
             KeptKeyframes::kMost);
  if (record.depth_delay != 0)
    log.info("depth images are {:.0f} ms off their stamps", 1000 * record.depth_delay);
  for (const std::string& warning : source.warnings()) {
    log.warn(warning);
    if (!quiet) fmt::print(stderr, "surefield: warning: {}\n", warning);
  }
}

}  // namespace

int run_session(const RunOptions& asked, const RunObservers& observers) {
  catch_interrupts();
  const RunOptions options = with_depth_delay(asked);
  const Dataset dataset = open_run_dataset(options);
  SlamSettings settings;
  const std::string effective = load_settings(settings, options, dataset.recording->format());
  FrameStream stream(*dataset.recording, options.selection);
  RunRecord record = start_record(options, stream);
  record.depth_max = settings.depth_max;
  ResultsFolder results(options.out);
  write_text(results.path() / "config.yaml", effective);

  const Clock::time_point start = Clock::now();
  Slam slam(settings, stream.intrinsics(), options.engine);
  record.setup_seconds = seconds_since(start);
  announce(results.log(), record, stream, slam, options.quiet);

  KeptKeyframes kept;
  RunObservers all = observers;
  all.push_back(&kept);
  for (RunObserver* observer : all) observer->begin({stream, dataset.truth(), settings, results.log()});
  const std::exception_ptr failure = run(record, stream, slam, results.log(), all, options.quiet);
  complete_record(record, slam, stream, dataset.truth());
  save_results(results, record, slam, stream, kept, options.map_format);
  report(results, record, options.quiet);
  for (RunObserver* observer : all) observer->finished(slam);
  for (const std::string& problem : results.problems()) print_error(problem);
  if (failure) std::rethrow_exception(failure);
  if (!results.problems().empty()) return kFailure;
  return interrupted() ? kInterrupted : kSuccess;
}

}  // namespace surefield
