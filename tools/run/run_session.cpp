#include "tools/run/run_session.h"

#include <fmt/format.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <new>

#include "engine/formats/map_file.h"
#include "engine/gpu/error.h"
#include "engine/io/files.h"
#include "engine/io/trajectory_file.h"
#include "engine/session/frame_table.h"
#include "engine/session/kept_keyframes.h"
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

/// The folder of the results with its log.
class Results {
 public:
  explicit Results(const std::filesystem::path& folder) : folder_(folder), log_("surefield") {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw InputError(folder, "cannot be created: " + error.message());
    try {
      log_.sinks().push_back(
          std::make_shared<spdlog::sinks::basic_file_sink_mt>((folder / "log.txt").string(), true));
    } catch (const spdlog::spdlog_ex& problem) {
      throw InputError(folder, "cannot be written to; check its permissions");
    }
    log_.set_pattern("%Y-%m-%d %H:%M:%S.%e %l: %v");
    log_.flush_on(spdlog::level::info);
    // A log that cannot be written on is no reason to stop.
    log_.set_error_handler([](const std::string&) {});
  }

  /// Writes one file; a failure is logged and kept, so that the other files are written all the same.
  template <typename Write>
  void save(const std::string& name, Write write) {
    try {
      write(folder_ / name);
    } catch (...) {
      problems_.push_back(name + " is not saved: " + describe_current_exception());
      log_.error(problems_.back());
    }
  }

  spdlog::logger& log() { return log_; }
  const std::filesystem::path& folder() const { return folder_; }
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  std::filesystem::path folder_;
  spdlog::logger log_;
  std::vector<std::string> problems_;
};

void write_text(const std::filesystem::path& file, const std::string& text) {
  write_file(file, [&](std::ostream& stream) { stream << text; });
}

/// Feeds the frames of a source to SLAM and keeps account.
class Feeder {
 public:
  Feeder(FrameSource& source, Slam& slam, spdlog::logger& log, const RunObservers& observers, bool quiet)
      : source_(source), slam_(slam), log_(log), observers_(observers), progress_(source.size(), quiet) {}

  /// Until the last frame, an interruption or an error, which is thrown.
  void feed_all() {
    while (!interrupted()) {
      for (RunObserver* observer : observers_) observer->before_frame(slam_);
      if (interrupted()) return;
      const std::optional<Frame> frame = source_.next();
      note_unreadable();
      if (!frame) return slam_.finish();
      feed(*frame);
    }
  }

  const std::vector<SkippedFrame>& skipped() const { return skipped_; }

 private:
  void feed(const Frame& frame) {
    try {
      const FrameReport report = slam_.feed(frame);
      log_.log(
          report.lost ? spdlog::level::warn : spdlog::level::info,
          "frame {}:{}{} loss {:.5f}, valid {:.3f}, tracking {} its {:.0f} ms, mapping {} its {:.0f} ms, "
          "{} Gaussians",
          report.index, report.keyframe ? " keyframe," : "", report.lost ? " lost," : "",
          report.tracking_loss, report.valid_fraction, report.tracking_iterations, report.tracking_ms,
          report.mapping_iterations, report.mapping_ms, report.gaussians);
      progress_.fed(report);
      for (RunObserver* observer : observers_) observer->fed(frame, slam_, report);
    } catch (const gpu::Error&) {
      throw;
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception&) {
      if (!slam_.usable()) throw;
      skip({frame.index, describe_current_exception()});
    }
  }

  void note_unreadable() {
    for (; unreadable_ < source_.problems().size(); ++unreadable_) skip(source_.problems()[unreadable_]);
  }

  void skip(const SkippedFrame& frame) {
    skipped_.push_back(frame);
    log_.warn("frame {} skipped: {}", frame.index, frame.reason);
    progress_.skipped(fmt::format("frame {}: {}", frame.index, frame.reason));
  }

  FrameSource& source_;
  Slam& slam_;
  spdlog::logger& log_;
  const RunObservers& observers_;
  Progress progress_;
  std::size_t unreadable_ = 0;  ///< of source_.problems(), those noted so far
  std::vector<SkippedFrame> skipped_;
};

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

/// Feeds the frames to the end, or to an interruption or an error, which is returned; `record` learns how it
/// went.
std::exception_ptr feed_frames(RunRecord& record, FrameSource& source, Slam& slam, spdlog::logger& log,
                               const RunObservers& observers, bool quiet) {
  std::exception_ptr failure;
  const Clock::time_point start = Clock::now();
  Feeder feeder(source, slam, log, observers, quiet);
  try {
    feeder.feed_all();
  } catch (...) {
    failure = std::current_exception();
    record.error = describe_current_exception();
    log.error(record.error);
  }
  record.seconds = seconds_since(start);
  record.skipped = feeder.skipped();
  record.end = failure ? RunEnd::Failed : interrupted() ? RunEnd::Interrupted : RunEnd::Completed;
  return failure;
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

/// Saves the map in one format and removes what an earlier run left in another, which is not this run's map.
void save_map(Results& results, const std::string& format, const GaussianCloud& map) {
  for (const std::string& other : run_map_formats()) {
    std::error_code ignored;
    if (other != format) std::filesystem::remove(results.folder() / ("map." + other), ignored);
  }
  results.save("map." + format, [&](const auto& file) { write_map(file, map); });
}

void save_results(Results& results, RunRecord& record, const Slam& slam, const FrameSource& source,
                  const KeptKeyframes& kept, const std::string& map_format) {
  const auto save_trajectory = [&](const std::string& name, const Trajectory& trajectory) {
    results.save(name,
                 [&](const auto& file) { write_trajectory(file, of_reference_camera(trajectory, source)); });
  };
  save_trajectory("trajectory.txt", record.trajectory);
  save_trajectory("keyframes.txt", record.keyframes);
  save_map(results, map_format, slam.map());
  if (record.end == RunEnd::Completed) {
    results.save("the image quality",
                 [&](const auto&) { record.images = measure_images(record, slam, source, kept); });
  }
  results.save("frames.csv", [&](const auto& file) { write_text(file, frames_csv(record.frames)); });
  results.save("metrics.json", [&](const auto& file) { write_text(file, metrics_json(record)); });
}

/// Tells the log, and unless `quiet` the user, how the run went.
void report(Results& results, const RunRecord& record, bool quiet) {
  for (const std::string& message : record.engine.validation_messages) {
    results.log().error("validation: {}", message);
    fmt::print(stderr, "surefield: validation: {}\n", message);
  }
  const std::string summary = run_summary(record);
  results.log().info("summary\n{}", summary);
  if (!quiet) fmt::print("{}results          {}\n", summary, results.folder().string());
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
  Results results(options.out);
  write_text(results.folder() / "config.yaml", effective);

  const Clock::time_point start = Clock::now();
  Slam slam(settings, stream.intrinsics(), options.engine);
  record.setup_seconds = seconds_since(start);
  announce(results.log(), record, stream, slam, options.quiet);

  KeptKeyframes kept;
  RunObservers all = observers;
  all.push_back(&kept);
  for (RunObserver* observer : all) observer->begin({stream, dataset.truth(), settings, results.log()});
  const std::exception_ptr failure = feed_frames(record, stream, slam, results.log(), all, options.quiet);
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
