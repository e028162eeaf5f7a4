#include "tools/run/run_session.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <exception>

#include "engine/session/kept_keyframes.h"
#include "engine/session/results_folder.h"
#include "engine/session/run_log.h"
#include "engine/session/run_sequence.h"
#include "engine/types/build_info.h"
#include "engine/types/error.h"
#include "engine/types/version.h"
#include "tools/results/run_record.h"
#include "tools/run/cost_note.h"
#include "tools/run/pose_stream.h"
#include "tools/run/run_doubts.h"
#include "tools/run/run_input.h"
#include "tools/run/run_results.h"
#include "tools/shared/command.h"
#include "tools/shared/interrupt.h"
#include "tools/shared/progress.h"
#include "tools/shared/say.h"

namespace surefield {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kLeastPosed = 0.97;   // share of the frames that a result to be trusted has poses for
constexpr int kDoubtfulEnd = 3;        // frames without a good pose at the end that are worth a warning
constexpr double kManyUnusable = 0.1;  // share of the frames that is worth a warning
constexpr std::chrono::milliseconds kReadPatience{500};  // for a frame that is being read when the run ends

/// What the source of the frames says about a run before it starts.
RunRecord start_record(const RunOptions& options, const FrameSource& source) {
  RunRecord record;
  record.dataset = source.name();
  record.dataset_path = dataset_path(options);
  record.format = source.format();
  record.depth_delay = options.depth_delay.value_or(0);
  record.estimated_depth_delay = options.estimated_depth_delay;
  record.assumed_camera = options.assumed_camera;
  record.assumed_depth_unit = options.assumed_depth_unit;
  record.colour_topic = options.colour_topic;
  record.depth_topic = options.depth_topic;
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
  const SequenceRun run = run_sequence(source, slam, observers, interruption());
  record.end = run.end;
  record.seconds = run.seconds;
  record.skipped = run.skipped;
  if (run.failure) {
    record.error = describe(run.failure);
    log.error(record.error);
  }
  return run.failure;
}

/// A line for the log and the user, also where that wants to see errors only.
void warn(spdlog::logger& log, const std::string& text) {
  log.warn(text);
  say(stderr, "surefield: warning: {}\n", text);
}

/// Whether more of the frames have no pose than a result to be trusted may lack.
bool many_lost(const RunRecord& record) {
  return !record.frames.empty() && record.pose_share() < kLeastPosed;
}

/// Says where many frames were of no use, which the trajectory alone does not show.
void warn_of_unusable(spdlog::logger& log, const RunRecord& record) {
  const std::size_t unusable = record.skipped.size(), all = unusable + record.frames.size();
  if (static_cast<double>(unusable) <= kManyUnusable * static_cast<double>(all)) return;
  warn(log, fmt::format("{} of {} frames could not be used, the first because: {}", unusable, all,
                        record.skipped.front().reason));
}

/// Says where the run was lost, or nearly so, when it ended.
void warn_of_end(spdlog::logger& log, const RunRecord& record) {
  const int doubtful = record.doubtful_end();
  if (doubtful < kDoubtfulEnd) return;
  warn(log, fmt::format(
                "the poses of the last {} frames are uncertain or not known; what they saw is not in the map",
                doubtful));
}

/// Says what looks wrong before the first frame, and what is left out; returns whether anything looks wrong.
bool warn_of_doubts(spdlog::logger& log, const RunInput& input, const RunOptions& options,
                    const SlamSettings& settings) {
  const FirstLook look = input.recording() ? look_first(*input.recording(), options.selection,
                                                        {settings.depth_max, reach_of(settings.sensor)})
                                           : FirstLook{implausible(input.source().intrinsics())};
  for (const std::string& warning : input.source().warnings()) warn(log, warning);
  for (const std::string& doubt : look.doubts) warn(log, doubt);
  if (look.beyond > 0) {
    const std::string text = fmt::format("depth_max, {:g} m, leaves out {:.1f} % of the depth",
                                         settings.depth_max, 100 * look.beyond);
    log.info(text);
    if (!options.quiet) say(stderr, "surefield: {}\n", text);
  }
  return !look.doubts.empty();
}

/// Tells the log, and unless `quiet` the user, how the run went.
void report(ResultsFolder& results, const RunRecord& record, const RunOptions& options) {
  for (const std::string& message : record.engine.validation_messages) {
    results.log().error("validation: {}", message);
    say(stderr, "surefield: validation: {}\n", message);
  }
  warn_of_unusable(results.log(), record);
  warn_of_end(results.log(), record);
  const std::string summary = run_summary(record);
  results.log().info("summary\n{}", summary);
  // Standard output belongs to the poses where they go there.
  std::FILE* const to = options.poses == "-" ? stderr : stdout;
  if (!options.quiet) say(to, "{}results          {}\n", summary, results.path().string());
}

/// Tells the log what runs on what, and the user, unless that wants errors only, what was assumed about the
/// source.
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
  for (const std::string& assumption : source.assumptions()) {
    log.info("assumed: {}", assumption);
    if (!quiet) say(stderr, "surefield: assumed: {}\n", assumption);
  }
}

bool has_unix_stamps(const RunInput& input) {
  return input.framed_stream() && input.framed_stream()->header().unix_stamps;
}

/// Has poses go back to the sender that asks for them; `stream` may be null.
void answer_sender(PoseStream& poses, StreamSource* stream, spdlog::logger& log) {
  if (!stream || !stream->header().wants_poses) return;
  poses.add_sink([stream, &log](const std::string& line) {
    const bool sent = stream->answer(line);
    if (!sent) log.warn("the sender reads no more poses; it gets none from here on");
    return sent;
  });
}

/// Says where a sender has gone without a word; `stream` may be null.
void warn_of_sender(spdlog::logger& log, const StreamSource* stream) {
  if (stream && stream->ended_early() && !interrupted())
    warn(log, "the sender went away without the message that ends a stream; what it sent is saved");
}

/// The exit code of a run that has ended, where it was not for an error.
int exit_code(const ResultsFolder& results, bool stopped, bool doubtful) {
  for (const std::string& problem : results.problems()) print_error(problem);
  if (!results.problems().empty()) return kFailure;
  if (stopped) return kInterrupted;
  return doubtful ? kDoubtful : kSuccess;
}

}  // namespace

int run_session(const RunOptions& asked, const RunObservers& observers) {
  ResultsFolder results(asked.out, asked.overwrite);
  clean_up_when_ended([&] { results.discard(); });
  const RunOptions options = with_depth_delay(asked);
  PoseStream poses;
  if (!options.poses.empty()) poses.add_place(options.poses);
  RunInput input(options);
  if (input.given_up()) return kInterrupted;
  SlamSettings settings;
  const std::string configuration = load_settings(settings, options, input.source().format());
  FrameSelection selection = options.selection;
  selection.hopeless = static_cast<int>(kHopelessFrames);
  input.stream(selection);
  FrameSource& stream = input.frames();
  if (warn_of_doubts(results.log(), input, options, settings) && options.strict) return kDoubtful;
  RunRecord record = start_record(options, stream);
  record.depth_max = settings.depth_max;
  record.noise = noise_of(settings.sensor);

  const Clock::time_point start = Clock::now();
  Slam slam(settings, stream.intrinsics(), options.engine);
  record.setup_seconds = seconds_since(start);
  announce(results.log(), record, stream, slam, options.quiet);

  LiveMeter meter(has_unix_stamps(input));
  const RunOutput output{results,    stream, input.truth(), configuration, options.map_format,
                         options.up, meter};
  KeptKeyframes kept;
  Checkpoints checkpoints(output, record);
  CostNote cost(options.selection.scale);
  answer_sender(poses, input.framed_stream(), results.log());
  RunObservers all = {&meter, &poses};  // before those that take their time
  all.insert(all.end(), observers.begin(), observers.end());
  all.insert(all.end(), {&kept, &checkpoints});
  if (!options.quiet) all.push_back(&cost);
  for (RunObserver* observer : all) observer->begin({stream, input.truth(), settings, results.log()});
  const std::exception_ptr failure = run(record, stream, slam, results.log(), all, options.quiet);
  warn_of_sender(results.log(), input.framed_stream());
  save_results(output, record, slam, kept);
  const bool stopped = interrupted();  // from here on nothing is lost where nobody reads what is said
  if (!record.frames.empty()) report(results, record, options);
  for (RunObserver* observer : all) observer->finished(slam);
  const bool doubtful = record.doubtful_end() >= kDoubtfulEnd || many_lost(record);
  const int code = exit_code(results, stopped, options.strict && doubtful);
  // A read from a disk that does not answer may last for ever.
  if (interrupted() && !input.idle_within(kReadPatience)) leave(code);
  if (failure) std::rethrow_exception(failure);
  return code;
}

}  // namespace surefield
