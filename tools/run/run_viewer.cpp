#include "tools/run/run_viewer.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <future>

#include "engine/eval/trajectory_metrics.h"
#include "engine/types/error.h"
#include "engine/window/viewer.h"
#include "tools/run/run_session.h"
#include "tools/shared/command.h"
#include "tools/shared/interrupt.h"
#include "tools/shared/say.h"

namespace surefield {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kPatience{100};  // between looks whether the user has interrupted

/// The settings that a user may change while a run goes on.
constexpr const char* kLiveSettings[] = {
    "mapping_iterations",   "keyframes.interval",      "keyframes.valid_below",     "gauss_newton.renders",
    "gauss_newton.balance", "tracking.outlier_factor", "mapping.uncertainty_above", "spawn.opacity_below"};

/// Hands a run over to a window, and what the user wants over to the run.
class ViewerObserver : public RunObserver {
 public:
  ViewerObserver(LiveFeed& feed, std::string out) : feed_(feed), out_(std::move(out)) {}

  /// What the window shows at first, when the run has begun; or why it has not.
  std::future<ViewerInput> input() { return input_.get_future(); }
  /// The run has failed with the exception that is being handled.
  void fail() {
    if (!begun_) input_.set_exception(std::current_exception());
  }

  void begin(const RunStart& start) override {
    source_ = &start.source;
    truth_ = start.ground_truth;
    log_ = &start.log;
    settings_ = start.settings;
    settings_.bind(schema_);
    ViewerInput input;
    input.title = "Surefield: " + start.source.name();
    input.out = out_;
    input.depth_model = settings_.depth_model;
    if (settings_.depth_max > 0) input.depth_far = settings_.depth_max;
    input.live = &feed_;
    input.interrupted = [this] { return interrupted() && !feed_.stop_wanted(); };
    for (const char* key : kLiveSettings) input.settings.push_back(schema_.number(key));
    // The window outlives the run, and its log.
    input.note = [](const std::string& text) { say(stdout, "{}\n", text); };
    input.scene.status = "waiting for the first frame";
    input.scene.waiting_for = "Waiting for the first frame";
    begun_ = true;
    input_.set_value(std::move(input));
  }

  void before_frame(Slam& slam) override {
    while (!feed_.may_go_on(kPatience) && !interrupted()) {
    }
    if (feed_.stop_wanted()) interrupt();
    const auto changes = feed_.take_changes();
    for (const auto& [key, value] : changes) {
      const std::string number =
          schema_.number(key).whole ? fmt::format("{}", std::lround(value)) : fmt::format("{}", value);
      schema_.set(key + "=" + number);
      log_->info("the user has set {}={}", key, number);
    }
    if (!changes.empty()) slam.change(settings_);
  }

  void tracked(const Frame& frame, const FrameReport&) override {
    if (frame.arrived)
      latency_ms_ = std::chrono::duration<double, std::milli>(Clock::now() - *frame.arrived).count();
    if (fed_ > 0) return;
    ViewerScene scene;
    scene.status = "the first frame";
    scene.waiting_for = fmt::format("The first frame becomes a map, in {} steps", settings_.first_iterations);
    scene.frame = {0, {source_->intrinsics()}, frame.colour, frame.depth};
    feed_.announce(std::move(scene));
  }

  void skipped(const SkippedFrame& frame) override {
    if (fed_ > 0) return;
    ViewerScene scene;
    scene.status = fmt::format("frame {} could not be used", frame.index);
    scene.waiting_for = fmt::format("Frame {} could not be used: {}", frame.index, frame.reason);
    feed_.announce(std::move(scene));
  }

  void fed(const Frame& frame, const Slam& slam, const FrameReport& report) override {
    const Clock::time_point now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    ++fed_;
    if (report.keyframe) measure(slam);
    const FrameNumbers numbers{.loss = static_cast<float>(report.tracking_loss),
                               .frames_per_second = static_cast<float>(1 / seconds),
                               .gaussians = static_cast<float>(report.gaussians),
                               .ate_cm = ate_cm_};
    frame_ = frame;
    feed_.publish(
        numbers, report.keyframe,
        [&] {
          const std::optional<int> frames = source_->size();
          return scene(slam, fmt::format("frame {}{}{}{}", fed_, frames ? fmt::format(" of {}", *frames) : "",
                                         report.lost() ? ", lost" : "", live_status()));
        },
        [&] { return slam.map(); });
  }

  void finished(const Slam& slam) override {
    feed_.finish(scene(slam, fmt::format("{} frames done; the results are in {}", fed_, out_)), slam.map());
  }

 private:
  /// Compares the trajectory with the truth.
  void measure(const Slam& slam) {
    if (!truth_) return;
    try {
      const auto metrics = evaluate_trajectory(of_reference_camera(slam.trajectory(), *source_), *truth_);
      ate_cm_ = static_cast<float>(100 * metrics.ate.rmse);
      to_estimate_ = metrics.alignment.inverse();
    } catch (const InputError&) {
      // Too few poses to compare yet.
    }
  }

  /// Of a live source: how many frames come, and what becomes of them.
  std::string live_status() const {
    const auto counts = source_->live();
    if (!counts) return {};
    return fmt::format("; {:.0f} a second come, {} dropped, pose after {:.0f} ms", counts->rate(),
                       counts->dropped, latency_ms_);
  }

  ViewerScene scene(const Slam& slam, std::string status) const {
    ViewerScene scene;
    scene.trajectory = slam.trajectory();
    scene.keyframes = slam.keyframes();
    scene.window = slam.window();
    scene.loops = links_of(slam.loops());
    scene.status = std::move(status);
    if (scene.trajectory.empty()) return scene;
    const StampedPose &oldest = scene.trajectory.front(), &newest = scene.trajectory.back();
    scene.frame = {
        fed_ - 1, {source_->intrinsics(), newest.camera_to_world.inverse()}, frame_.colour, frame_.depth};
    if (!std::isfinite(ate_cm_)) return scene;
    for (const StampedPose& pose : *truth_)
      if (pose.timestamp >= oldest.timestamp && pose.timestamp <= newest.timestamp)
        scene.truth.push_back({pose.timestamp, to_estimate_ * pose.camera_to_world});
    scene.truth = of_tracked_camera(std::move(scene.truth), *source_);
    return scene;
  }

  LiveFeed& feed_;
  std::string out_;
  std::promise<ViewerInput> input_;
  bool begun_ = false;
  const FrameSource* source_ = nullptr;
  const Trajectory* truth_ = nullptr;  ///< null where there is none
  spdlog::logger* log_ = nullptr;
  SlamSettings settings_;
  ConfigSchema schema_;
  Clock::time_point last_ = Clock::now();
  int fed_ = 0;
  Frame frame_;            ///< the newest
  double latency_ms_ = 0;  ///< of the newest frame of a live source
  float ate_cm_ = NAN;
  Eigen::Isometry3d to_estimate_ = Eigen::Isometry3d::Identity();  ///< from the world of the truth
};

/// Shows the window; where that fails, the run goes on without.
void show(ViewerInput input, const RunOptions& options) {
  input.engine = options.engine;
  if (options.up.way == UpChoice::Way::Given) input.up = options.up.given;
  input.ui_scale = options.ui_scale;
  try {
    for (const std::string& message : show_viewer(std::move(input)))
      say(stderr, "surefield: validation: {}\n", message);
  } catch (const std::exception&) {
    say(stderr, "surefield: warning: the run goes on without the viewer: {}\n", describe_current_exception());
  }
}

}  // namespace

int run_with_viewer(const RunOptions& options, const RunObservers& observers) {
  if (const std::string problem = viewer_problem(); !problem.empty())
    throw InputError("--viewer: " + problem +
                     "; or run without it, and look with surefield render or report");
  LiveFeed feed;
  ViewerObserver observer(feed, options.out);
  RunObservers all = observers;
  all.push_back(&observer);
  std::future<ViewerInput> input = observer.input();
  std::future<int> run = std::async(std::launch::async, [&] {
    try {
      return run_session(options, all);
    } catch (...) {
      observer.fail();
      throw;
    }
  });
  input.wait();
  try {
    show(input.get(), options);
  } catch (...) {
    // The run tells why it failed.
  }
  feed.pause(false);
  return run.get();
}

}  // namespace surefield
