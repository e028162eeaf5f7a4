#include "tools/shared/progress.h"

#include <doctest/doctest.h>

#include <cmath>

#include "tools/shared/numbers.h"

using namespace surefield;

TEST_CASE("the pace follows frames that become slower, and a keyframe changes it little") {
  RecentPace pace;
  CHECK_FALSE(pace.known());
  for (int i = 0; i < 10; ++i) pace.add(1);
  CHECK(pace.seconds_each() == doctest::Approx(1));
  for (int i = 0; i < 200; ++i) pace.add(3);
  CHECK(pace.seconds_each() > 2.99);  // the mean of all would be 2.9
  const double before = pace.seconds_each();
  pace.add(9);
  CHECK(pace.seconds_each() < 1.1 * before);
  RecentPace few;
  few.add(1);
  few.add(3);
  CHECK(few.seconds_each() == doctest::Approx(2));
}

TEST_CASE("numbers that are none are shown as a dash") {
  CHECK(shown(1.2345, 2) == "1.23");
  CHECK(shown(NAN, 2) == "-");
  CHECK(shown(-NAN, 2) == "-");
  CHECK(shown(INFINITY, 0) == "-");
}
