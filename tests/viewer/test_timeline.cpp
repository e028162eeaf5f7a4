#include "engine/viewer/timeline.h"

#include <doctest/doctest.h>

using namespace surefield;

namespace {

Trajectory at_times(std::initializer_list<double> times) {
  Trajectory trajectory;
  for (double time : times) trajectory.push_back({.timestamp = time});
  return trajectory;
}

}  // namespace

TEST_CASE("a timeline counts seconds from the first frame, and finds the frame of a time") {
  const Trajectory trajectory = at_times({1311868164.36, 1311868164.40, 1311868164.43, 1311868165.43});
  const Timeline timeline(trajectory);
  CHECK(timeline.duration() == doctest::Approx(1.07));
  CHECK(timeline.seconds_at(0) == 0);
  CHECK(timeline.seconds_at(2) == doctest::Approx(0.07));
  CHECK(timeline.seconds_at(9) == timeline.duration());
  CHECK(timeline.seconds_at(-1) == 0);
  for (int position = 0; position < 4; ++position)
    CHECK(timeline.position_at(timeline.seconds_at(position)) == position);
  CHECK(timeline.position_at(-1) == 0);
  CHECK(timeline.position_at(0.05) == 1);
  CHECK(timeline.position_at(1) == 2);
  CHECK(timeline.position_at(5) == 3);
}

TEST_CASE("without frames, a timeline is empty") {
  const Trajectory none;
  const Timeline timeline(none);
  CHECK(timeline.duration() == 0);
  CHECK(timeline.seconds_at(3) == 0);
  CHECK(timeline.position_at(3) == 0);
}

TEST_CASE(
    "playback takes as long as the recording did, begins anew, and goes on from a frame that is chosen") {
  const Trajectory trajectory = at_times({10, 10.1, 10.5, 11});
  const Timeline timeline(trajectory);
  Playback playback;
  int position = 0, shown[4] = {0, 0, 0, 0};
  for (int i = 0; i < 99; ++i) ++shown[position = playback.advance(timeline, position, 0.01)];
  CHECK(shown[0] == doctest::Approx(9).epsilon(0.2));
  CHECK(shown[1] == doctest::Approx(40).epsilon(0.05));
  CHECK(shown[2] == doctest::Approx(50).epsilon(0.05));
  CHECK(playback.advance(timeline, position, 0.2) == 0);
  position = 2;  // as the user wants
  CHECK(playback.advance(timeline, position, 0.01) == 2);
  CHECK(playback.seconds == doctest::Approx(0.51));
}
