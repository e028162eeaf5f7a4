#include "engine/viewer/scales.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace surefield;

TEST_CASE("a scale bar has the longest of 1, 2 and 5 times a power of ten that fits") {
  CHECK(round_below(1) == doctest::Approx(1));
  CHECK(round_below(1.99) == doctest::Approx(1));
  CHECK(round_below(2) == doctest::Approx(2));
  CHECK(round_below(4.9) == doctest::Approx(2));
  CHECK(round_below(7) == doctest::Approx(5));
  CHECK(round_below(0.09) == doctest::Approx(0.05));
  CHECK(round_below(0.1) == doctest::Approx(0.1));
  CHECK(round_below(43) == doctest::Approx(20));
  for (double most = 1e-4; most < 1e4; most *= 1.07) {
    const double length = round_below(most);
    const double digit = length / std::pow(10, std::floor(std::log10(length) + 1e-9));
    CHECK(std::min({std::abs(digit - 1), std::abs(digit - 2), std::abs(digit - 5)}) < 1e-6);
    CHECK(length <= most * (1 + 1e-6));
    CHECK(length > most / 2.51);
  }
}

TEST_CASE("ticks are multiples of one round step within a scale, as many as may be") {
  CHECK(ticks_between(0, 5, 6) == std::vector<double>{0, 1, 2, 3, 4, 5});
  CHECK(ticks_between(0, 20, 6) == std::vector<double>{0, 5, 10, 15, 20});
  CHECK(ticks_between(0.5, 4.4, 5) == std::vector<double>{1, 2, 3, 4});
  CHECK(ticks_between(3, 3, 6).empty());
  CHECK_FALSE(std::signbit(ticks_between(0, 5, 6).front()));
  for (double high = 0.013; high < 400; high *= 1.19)
    for (double low : {0.0, 0.3 * high}) {
      const std::vector<double> ticks = ticks_between(low, high, 6);
      CAPTURE(high);
      REQUIRE(ticks.size() >= 2);
      CHECK(ticks.size() <= 6);
      CHECK(ticks.front() >= low * (1 - 1e-6));
      CHECK(ticks.back() <= high * (1 + 1e-6));
      const double step = ticks[1] - ticks[0];
      CHECK(ticks.front() - low < step * (1 + 1e-6));
      CHECK(high - ticks.back() < step * (1 + 1e-6));
    }
}

TEST_CASE("lengths and times are written as people say them") {
  CHECK(format_length(0) == "0.00 mm");
  CHECK(format_length(0.0004) == "0.40 mm");
  CHECK(format_length(0.00999) == "9.99 mm");
  CHECK(format_length(0.01) == "1.00 cm");
  CHECK(format_length(0.1234) == "12.3 cm");
  CHECK(format_length(0.9994) == "99.9 cm");
  CHECK(format_length(0.9996) == "1.00 m");
  CHECK(format_length(1.234) == "1.23 m");
  CHECK(format_length(12.34) == "12.3 m");
  CHECK(format_length(123.4) == "123 m");
  CHECK(format_round_length(round_below(0.0061)) == "5 mm");
  CHECK(format_round_length(round_below(0.34)) == "20 cm");
  CHECK(format_round_length(round_below(1.2)) == "1 m");
  CHECK(format_round_length(round_below(70)) == "50 m");
  CHECK(format_time(0) == "0.00 s");
  CHECK(format_time(7.254) == "7.25 s");
  CHECK(format_time(59.994) == "59.99 s");
  CHECK(format_time(59.996) == "1:00.0");
  CHECK(format_time(67.34) == "1:07.3");
  CHECK(format_time(3599.97) == "1:00:00");
  CHECK(format_time(3727) == "1:02:07");
}
