#include <doctest/doctest.h>

#include <atomic>
#include <stop_token>
#include <thread>

#include "engine/io/trajectory_file.h"
#include "engine/session/kept_keyframes.h"
#include "engine/session/run_sequence.h"
#include "engine/session/save_run.h"
#include "engine/sources/frame_stream.h"
#include "engine/sources/stream_source.h"
#include "engine/types/error.h"
#include "engine/types/gaussian_cloud.h"
#include "tests/slam/office.h"
#include "tests/support/input_files.h"
#include "tests/support/stream_writer.h"

using namespace surefield;
using namespace surefield::testing;
using test::contains;

namespace {

constexpr int kFrames = 6;

/// The office, but some of its frames cannot be read, are of the wrong size, or end the source.
class DamagedOffice : public FrameSource {
 public:
  std::string name() const override { return "office"; }
  std::string format() const override { return "test"; }
  Intrinsics intrinsics() const override { return office_.intrinsics(); }
  std::optional<int> size() const override { return std::nullopt; }
  const std::vector<SkippedFrame>& problems() const override { return problems_; }

  std::optional<Frame> next() override {
    if (stopped) return std::nullopt;
    if (next_ == unreadable) problems_.push_back({next_++, "damaged"});
    if (next_ == breaks_at) throw InputError("the camera was pulled out");
    if (next_ == kFrames) return std::nullopt;
    Frame frame = *office_.load(next_).frame;
    if (next_ == small || next_ < small_until) frame = resize_frame(frame, 0.5);
    ++next_;
    return frame;
  }

  void stop() override { stopped = true; }

  int unreadable = -1, small = -1, small_until = -1, breaks_at = -1;
  std::atomic<bool> stopped{false};

 private:
  const SyntheticRecording office_ = office(kFrames);
  std::vector<SkippedFrame> problems_;
  int next_ = 0;
};

/// Notes what it is told, and throws or stops at a frame.
class Watcher : public RunObserver {
 public:
  void before_frame(Slam&) override { ++before; }
  void tracked(const Frame& frame, const FrameReport& report) override {
    CHECK(known.size() == told.size());  // before the frame is in the map
    CHECK(report.index == frame.index);
    known.push_back(frame.index);
  }
  void fed(const Frame& frame, const Slam&, const FrameReport&) override {
    told.push_back(frame.index);
    if (frame.index == throws_at) throw InputError("the disk is full");
    if (frame.index == stops_at) stop.request_stop();
  }
  void skipped(const SkippedFrame& frame) override { passed_over.push_back(frame.index); }

  int throws_at = -1, stops_at = -1;
  int before = 0;
  std::vector<int> known, told, passed_over;
  std::stop_source stop;
};

struct Outcome {
  SequenceRun run;
  Trajectory trajectory;
  bool finished = false;
};

Outcome run(FrameSource& source, Watcher& watcher) {
  Slam slam(quick_settings(), source.intrinsics(), engine_options());
  Outcome outcome{run_sequence(source, slam, {&watcher}, watcher.stop.get_token()), slam.trajectory()};
  outcome.finished = !slam.usable();
  return outcome;
}

}  // namespace

TEST_CASE("a sequence is fed to its end, with the bits of feeding it frame by frame") {
  DamagedOffice source;
  Watcher watcher;
  const Outcome outcome = run(source, watcher);
  CHECK(outcome.run.end == RunEnd::Completed);
  CHECK(outcome.finished);
  CHECK(outcome.run.skipped.empty());
  CHECK(watcher.told == std::vector{0, 1, 2, 3, 4, 5});
  CHECK(watcher.known == watcher.told);
  CHECK(watcher.before == kFrames);

  const SyntheticRecording recording = office(kFrames);
  Slam slam(quick_settings(), recording.intrinsics(), engine_options());
  for (int i = 0; i < kFrames; ++i) slam.feed(*recording.load(i).frame);
  slam.finish();
  const Trajectory trajectory = slam.trajectory();
  REQUIRE(outcome.trajectory.size() == trajectory.size());
  for (std::size_t i = 0; i < trajectory.size(); ++i)
    CHECK(outcome.trajectory[i].camera_to_world.matrix() == trajectory[i].camera_to_world.matrix());
}

TEST_CASE("a framed stream of which every frame counts gives the bits of the recording that was sent") {
  const SyntheticRecording recording = office(kFrames);
  const Intrinsics k = recording.intrinsics();
  test::HeaderToSend header{.flags = 1,
                            .width = static_cast<uint32_t>(k.width),
                            .height = static_cast<uint32_t>(k.height),
                            .camera = {k.fx, k.fy, k.cx, k.cy}};
  std::string bytes = header.message();
  for (int i = 0; i < kFrames; ++i) {
    const Frame frame = *recording.load(i).frame;
    bytes += test::FrameToSend{.stamp = frame.timestamp,
                               .depth_kind = 2,
                               .colour = test::pixels_of(frame.colour),
                               .depth = test::pixels_of(frame.depth)}
                 .message();
  }
  StreamSource source(std::make_unique<test::MemoryBytes>(bytes + test::end_message(), 65536));
  FrameStream stream(source, {});
  Watcher watcher;
  const Outcome sent = run(stream, watcher);
  FrameStream frames(recording, {});
  Watcher other;
  const Outcome read = run(frames, other);
  CHECK(watcher.told == std::vector{0, 1, 2, 3, 4, 5});
  REQUIRE(sent.trajectory.size() == read.trajectory.size());
  for (std::size_t i = 0; i < sent.trajectory.size(); ++i) {
    CHECK(sent.trajectory[i].timestamp == read.trajectory[i].timestamp);
    CHECK(sent.trajectory[i].camera_to_world.matrix() == read.trajectory[i].camera_to_world.matrix());
  }
}

TEST_CASE("frames that cannot be read or fed are skipped and told, and the run goes on") {
  DamagedOffice source;
  source.unreadable = 2;
  source.small = 4;
  Watcher watcher;
  const Outcome outcome = run(source, watcher);
  CHECK(outcome.run.end == RunEnd::Completed);
  REQUIRE(outcome.run.skipped.size() == 2);
  CHECK(outcome.run.skipped[0].index == 2);
  CHECK(outcome.run.skipped[0].reason == "damaged");
  CHECK(outcome.run.skipped[1].index == 4);
  CHECK(watcher.told == std::vector{0, 1, 3, 5});
  CHECK(watcher.passed_over == std::vector{2, 4});
  CHECK(outcome.trajectory.size() == 4);
}

TEST_CASE("an interruption ends a run after the frame in work and does not finish the map") {
  DamagedOffice source;
  Watcher watcher;
  watcher.stops_at = 2;
  const Outcome outcome = run(source, watcher);
  CHECK(outcome.run.end == RunEnd::Interrupted);
  CHECK(outcome.run.failure == nullptr);
  CHECK_FALSE(outcome.finished);
  CHECK(watcher.told == std::vector{0, 1, 2});
  CHECK(source.stopped);
}

TEST_CASE("an interruption leaves out the mapping steps that remain, and ends a source that waits") {
  /// Gives one frame and then waits until it is stopped.
  class Waiting : public DamagedOffice {
   public:
    std::optional<Frame> next() override {
      if (!given_) return given_ = true, DamagedOffice::next();
      while (!stopped) std::this_thread::yield();
      return std::nullopt;
    }

   private:
    bool given_ = false;
  };
  Waiting source;
  Slam slam(quick_settings(), source.intrinsics(), engine_options());
  std::stop_source stop;
  std::thread user([&] {
    while (slam.reports().empty()) std::this_thread::yield();
    stop.request_stop();
  });
  const SequenceRun outcome = run_sequence(source, slam, {}, stop.get_token());
  user.join();
  CHECK(outcome.end == RunEnd::Interrupted);
  CHECK(slam.trajectory().size() == 1);

  Slam hurried(quick_settings(), source.intrinsics(), engine_options());
  hurried.stop_mapping();
  const FrameReport report = hurried.feed(*DamagedOffice().next());
  CHECK(report.mapping_iterations == 0);
  CHECK(hurried.map().size() > 0);
}

TEST_CASE("of a live source the next frame is taken when the one before is done") {
  /// Frames of which the newest wins; one of them cannot be fed.
  class Camera : public DamagedOffice {
   public:
    explicit Camera(const Watcher& watcher) : watcher_(watcher) { small = 2; }
    std::optional<LiveCounts> live() const override { return LiveCounts{}; }
    std::optional<Frame> next() override {
      CHECK(watcher_.told.size() + watcher_.passed_over.size() == taken_++);
      return DamagedOffice::next();
    }

   private:
    const Watcher& watcher_;
    std::size_t taken_ = 0;
  };
  Watcher watcher;
  Camera camera(watcher);
  const Outcome outcome = run(camera, watcher);
  CHECK(outcome.run.end == RunEnd::Completed);
  CHECK(watcher.told == std::vector{0, 1, 3, 4, 5});
  CHECK(watcher.passed_over == std::vector{2});
}

TEST_CASE("a run whose first frames cannot be used is given up, and says why once") {
  DamagedOffice source;
  Watcher watcher;
  source.small_until = 5;
  const Outcome outcome = run(source, watcher);
  CHECK(outcome.run.end == RunEnd::Failed);
  REQUIRE(outcome.run.failure);
  CHECK(
      contains(describe(outcome.run.failure), "none of the 5 frames so far can be used: the frame's images"));
  CHECK(watcher.told.empty());

  DamagedOffice late;
  Watcher patient;
  late.small_until = 4;
  CHECK(run(late, patient).run.end == RunEnd::Completed);
}

TEST_CASE("an error of the source or of an observer ends a run, and what was computed is there") {
  DamagedOffice source;
  Watcher watcher;
  SUBCASE("of the source") {
    source.breaks_at = 3;
  }
  SUBCASE("of an observer") {
    watcher.throws_at = 2;
  }
  const Outcome outcome = run(source, watcher);
  CHECK(outcome.run.end == RunEnd::Failed);
  REQUIRE(outcome.run.failure);
  CHECK_THROWS_AS(std::rethrow_exception(outcome.run.failure), InputError);
  CHECK(outcome.trajectory.size() >= 2);
  CHECK(outcome.trajectory.size() <= 3);
}

TEST_CASE("keyframes of a source that cannot be read again are kept, of a recording none") {
  const SlamSettings settings = quick_settings();
  spdlog::logger log("test");
  const auto kept_of = [&](FrameSource& source) {
    Slam slam(settings, source.intrinsics(), engine_options());
    KeptKeyframes kept;
    kept.begin({source, nullptr, settings, log});
    CHECK(run_sequence(source, slam, {&kept}).end == RunEnd::Completed);
    std::vector<int> indices;
    for (const Frame& frame : kept.frames()) indices.push_back(frame.index);
    return indices;
  };
  DamagedOffice live;
  CHECK(kept_of(live) == std::vector{0, 3});
  SyntheticRecording recording = office(kFrames);
  CHECK(kept_of(recording).empty());
}

TEST_CASE("a run is saved with what it has; a file that cannot be written does not keep the others") {
  const test::TemporaryFolder folder;
  DamagedOffice source;
  Slam slam(quick_settings(), source.intrinsics(), engine_options());
  slam.feed(*source.next());
  ResultsFolder results(folder / "run");
  const std::filesystem::path place = results.path();
  std::filesystem::create_directories(place / "frames.csv/in_the_way");
  std::ofstream(place / "map.spz") << "of an earlier state";
  save_run(results, slam, source);
  CHECK(read_trajectory(place / "trajectory.txt").size() == 1);
  CHECK(read_trajectory(place / "keyframes.txt").size() == 1);
  CHECK(std::filesystem::file_size(place / "map.ply") > 1000);
  CHECK_FALSE(std::filesystem::exists(place / "map.spz"));
  REQUIRE(results.problems().size() == 1);
  CHECK(results.problems().front().starts_with("frames.csv is not saved: "));
}
