// SLAM on a thread of its own: the same results, the queue, errors, endings, readers beside it.
#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <thread>

#include "engine/slam/slam_thread.h"
#include "engine/sources/frame_stream.h"
#include "engine/types/error.h"
#include "tests/slam/office.h"

using namespace surefield;
using namespace surefield::testing;

namespace {

using Result = std::future<std::optional<FrameReport>>;

Slam make_slam() {
  return Slam(quick_settings(), office_camera(), engine_options());
}

/// Holds the frames back until it is opened, and counts what is told.
class Gate : public SlamListener {
 public:
  explicit Gate(bool open) {
    if (open) this->open();
  }

  void open() { opened_.set_value(); }

  bool before_frame(Slam&) override {
    open_.wait();
    ++before;
    return goes_on;
  }
  void tracked(const Frame&, const FrameReport&) override { ++tracked_frames; }
  void mapped(const Frame& frame, const Slam& slam, const FrameReport& report) override {
    ++mapped_frames;
    CHECK(report.index == frame.index);
    CHECK(slam.reports().size() == static_cast<std::size_t>(mapped_frames));
    thread = std::this_thread::get_id();
  }
  void failed(const Frame&, const Slam&, const std::exception_ptr&) override { ++failed_frames; }

  // Read once the thread has ended.
  int before = 0;
  int tracked_frames = 0;
  int mapped_frames = 0;
  int failed_frames = 0;
  std::thread::id thread;
  std::atomic<bool> goes_on = true;

 private:
  std::promise<void> opened_;
  std::shared_future<void> open_ = opened_.get_future().share();
};

/// Lets the keyframe after three frames end in the middle of mapping.
class Breaker : public SlamListener {
 public:
  bool before_frame(Slam& slam) override {
    SlamSettings settings = quick_settings();
    settings.mapping_iterations = -1;
    if (slam.reports().size() == 3) slam.change(settings);
    return true;
  }
};

/// Ends the thread by an error of its own.
class Thrower : public SlamListener {
 public:
  void mapped(const Frame&, const Slam&, const FrameReport&) override { throw InputError("no disk"); }
};

bool is_blocked(const std::future<void>& work) {
  return work.wait_for(std::chrono::milliseconds(100)) == std::future_status::timeout;
}

}  // namespace

TEST_CASE("SLAM on a thread gives the bits of SLAM that is fed, and the poses before mapping") {
  const std::vector<Frame>& frames = office_frames();
  Slam fed = make_slam();
  for (int i = 0; i < 6; ++i) fed.feed(frames[i]);
  fed.finish();

  Slam slam = make_slam();
  Gate gate(true);
  SlamThread thread(slam, {.capacity = 3}, &gate);
  std::vector<Result> results;
  for (int i = 0; i < 6; ++i) results.push_back(thread.feed(frames[i]));
  for (int i = 0; i < 6; ++i) {
    const std::optional<FrameReport> report = results[i].get();
    REQUIRE(report);
    CHECK(report->index == frames[i].index);
    CHECK(report->mapping_iterations == 0);
    CHECK(slam.trajectory().size() > static_cast<std::size_t>(i));
  }
  thread.finish();
  thread.finish();
  CHECK(same_results(slam, fed));
  CHECK(thread.dropped() == 0);
  CHECK(gate.before == 6);
  CHECK(gate.tracked_frames == 6);
  CHECK(gate.mapped_frames == 6);
  CHECK(gate.thread != std::this_thread::get_id());
  CHECK_THROWS_AS(thread.feed(frames[6]).get(), StateError);
  CHECK(slam.engine_report().validation_messages.empty());
}

TEST_CASE("where the newest wins, the frames that have waited the longest are dropped and counted") {
  const std::vector<Frame>& frames = office_frames();
  Slam slam = make_slam();
  Gate gate(false);
  SlamThread thread(slam, {.policy = QueuePolicy::NewestWins, .capacity = 2}, &gate);
  std::vector<Result> results;
  for (int i = 0; i < 5; ++i) results.push_back(thread.feed(frames[i]));
  CHECK(thread.waiting() == 2);
  CHECK(thread.dropped() == 3);
  for (int i = 0; i < 3; ++i) CHECK_FALSE(results[i].get());
  gate.open();
  CHECK(results[3].get());
  CHECK(results[4].get());
  thread.finish();
  CHECK(slam.reports().size() == 2);
  CHECK(slam.reports()[0].index == frames[3].index);
}

TEST_CASE("where feeding blocks, a frame waits for room and none is lost") {
  const std::vector<Frame>& frames = office_frames();
  Slam slam = make_slam();
  Gate gate(false);
  SlamThread thread(slam, {.policy = QueuePolicy::Block, .capacity = 2}, &gate);
  const Result first = thread.feed(frames[0]), second = thread.feed(frames[1]);
  Result third;
  const std::future<void> feeding = std::async(std::launch::async, [&] { third = thread.feed(frames[2]); });
  CHECK(is_blocked(feeding));
  CHECK(thread.waiting() == 2);
  gate.open();
  feeding.wait();
  CHECK(third.get());
  thread.finish();
  CHECK(thread.dropped() == 0);
  CHECK(slam.reports().size() == 3);
  CHECK_THROWS_AS(SlamThread(slam, {.capacity = 0}), UsageError);
}

TEST_CASE("stopping drops the frames that wait, and lets go who waits for room") {
  const std::vector<Frame>& frames = office_frames();
  Slam slam = make_slam();
  Gate gate(false);
  SlamThread thread(slam, {.capacity = 2}, &gate);
  Result first = thread.feed(frames[0]), second = thread.feed(frames[1]);
  Result third;
  const std::future<void> feeding = std::async(std::launch::async, [&] { third = thread.feed(frames[2]); });
  CHECK(is_blocked(feeding));
  const std::future<void> stopping = std::async(std::launch::async, [&] { thread.stop(); });
  CHECK_FALSE(first.get());
  CHECK_FALSE(second.get());
  feeding.wait();
  CHECK_THROWS_AS(third.get(), StateError);
  gate.open();
  stopping.wait();
  CHECK(thread.dropped() == 2);
  CHECK_THROWS_AS(thread.feed(frames[3]).get(), StateError);
  CHECK_THROWS_AS(thread.finish(), StateError);
  CHECK(slam.trajectory().empty());
  CHECK(slam.usable());
}

TEST_CASE("the listener can stop the thread before a frame, and a thread that is let go stops by itself") {
  Slam slam = make_slam();
  Gate gate(true);
  gate.goes_on = false;
  Result only;
  {
    SlamThread thread(slam, {}, &gate);
    only = thread.feed(office_frames()[0]);
    CHECK_FALSE(only.get());
    CHECK(thread.dropped() == 1);
  }
  CHECK(slam.trajectory().empty());
  Result waits;
  {
    SlamThread thread(slam);
    waits = thread.feed(office_frames()[0]);
  }
  CHECK(waits.get().has_value() == (slam.trajectory().size() == 1));
}

TEST_CASE("an error comes with the frame's future, and the thread goes on") {
  const std::vector<Frame>& frames = office_frames();
  Slam slam = make_slam();
  Gate gate(true);
  SlamThread thread(slam, {.capacity = 4}, &gate);
  thread.feed(frames[0]);
  Result bad = thread.feed(resize_frame(frames[1], 0.5));
  Result good = thread.feed(frames[1]);
  CHECK_THROWS_AS(bad.get(), UsageError);
  CHECK(good.get());
  thread.finish();
  CHECK(gate.failed_frames == 1);
  CHECK(slam.reports().size() == 2);
}

TEST_CASE("an error in the middle of mapping ends the thread, and all that follows gets it") {
  const std::vector<Frame>& frames = office_frames();
  Slam slam = make_slam();
  Breaker breaker;
  SlamThread thread(slam, {.capacity = 8}, &breaker);
  std::vector<Result> results;
  for (int i = 0; i < 4; ++i) results.push_back(thread.feed(frames[i]));
  for (Result& result : results) CHECK(result.get());  // the pose of the last was known before
  CHECK_THROWS_AS(thread.finish(), std::length_error);
  CHECK_THROWS_AS(thread.feed(frames[4]).get(), std::length_error);
  CHECK_FALSE(slam.usable());
  CHECK(slam.trajectory().size() == 4);

  Slam other = make_slam();
  Thrower thrower;
  SlamThread watched(other, {}, &thrower);
  CHECK(watched.feed(frames[0]).get());
  CHECK_THROWS_WITH_AS(watched.finish(), "no disk", InputError);
  CHECK(other.usable());
}

TEST_CASE("others may read and render while SLAM works") {
  const std::vector<Frame>& frames = office_frames();
  Slam slam = make_slam();
  std::atomic<bool> over = false;
  int reads = 0;
  slam.feed(frames[0]);
  {
    SlamThread thread(slam);
    std::thread reader([&] {
      for (; !over; ++reads) {
        const RenderImages images = slam.render({office_camera(), Pose::Identity()});
        const Trajectory trajectory = slam.trajectory();
        if (images.colour.empty() || trajectory.empty() || slam.map().means.empty()) break;
        if (slam.reports().empty() || slam.keyframes().empty() || slam.window().empty()) break;
        if (slam.revision() > 0) break;
      }
    });
    for (int i = 1; i < 7; ++i) thread.feed(frames[i]);
    thread.finish();
    over = true;
    reader.join();
  }
  CHECK(over);
  CHECK(reads > 0);
  CHECK(slam.reports().size() == 7);
  CHECK(slam.engine_report().validation_messages.empty());
}
