// A recording at its own speed.
#include "engine/sources/timed_replay.h"

#include <doctest/doctest.h>

#include <future>
#include <thread>

#include "tests/sources/fake_recording.h"
#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;
using test::input_error;

namespace {

/// Frames so many seconds apart.
class Stamped : public test::FakeRecording {
 public:
  Stamped(int size, double apart) : FakeRecording(size), apart_(apart) {}
  double timestamp(int i) const override { return 100.5 + apart_ * i; }

 private:
  double apart_;
};

}  // namespace

TEST_CASE("a slow reader gets the newest frame, and what it missed is counted and never loaded") {
  const Stamped recording(6, 0.02);
  TimedReplay replay(recording);
  CHECK(replay.next()->index < 5);
  std::this_thread::sleep_until(std::chrono::steady_clock::now() + std::chrono::milliseconds(100));
  const auto frame = replay.next();  // all of them have arrived
  REQUIRE(frame);
  CHECK(frame->index == 5);
  CHECK(frame->arrived);
  CHECK_FALSE(replay.next());
  CHECK(recording.loads == 2);
  CHECK(replay.live()->arrived == 6);
  CHECK(replay.live()->dropped == 4);
  CHECK(replay.live()->seconds == doctest::Approx(0.1));
  CHECK(replay.recording() == &recording);
}

TEST_CASE("a reader waits until a frame has arrived, and each is given or dropped") {
  const Stamped recording(4, 0.5);
  TimedReplay replay(recording, 25);  // 50 frames a second
  uint64_t given = 0;
  while (const auto frame = replay.next()) {
    CHECK(frame->arrived <= std::chrono::steady_clock::now());
    ++given;
  }
  CHECK(given + replay.live()->dropped == 4);
  CHECK(given == static_cast<uint64_t>(recording.loads));
}

TEST_CASE("a wait for the next frame ends by stop()") {
  const Stamped recording(2, 1e6);
  TimedReplay replay(recording);
  CHECK(replay.next());
  auto waiting = std::async(std::launch::async, [&] { return replay.next().has_value(); });
  replay.stop();
  CHECK_FALSE(waiting.get());
}

TEST_CASE("numbers are no stamps, frames that cannot be read are told, and time does not go back") {
  test::FakeRecording numbered(3);
  numbered.missing = 0;
  TimedReplay replay(numbered);
  REQUIRE(replay.assumptions().size() == 1);
  CHECK(contains(replay.assumptions()[0], "30 come a second"));
  CHECK(replay.next());
  CHECK(replay.problems().size() == 1);
  CHECK(TimedReplay(Stamped(3, 0.1)).assumptions().empty());
  CHECK(contains(input_error([] { TimedReplay(Stamped(3, -0.1)); }), "cannot be replayed"));
}
