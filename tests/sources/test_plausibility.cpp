#include "engine/sources/plausibility.h"

#include "tests/support/input_files.h"

using namespace surefield;
using test::contains;

namespace {

std::string all(const std::vector<std::string>& findings) {
  std::string text;
  for (const std::string& finding : findings) text += finding + "\n";
  return text;
}

DepthRange room(double factor) {
  return {0.6 * factor, 1.8 * factor, 4.2 * factor, 0.1, 0};
}

}  // namespace

TEST_CASE("cameras that exist are plausible") {
  for (const Intrinsics& k :
       {Intrinsics{640, 480, 517.3, 516.5, 318.6, 255.3}, Intrinsics{1200, 680, 600, 600, 599.5, 339.5},
        Intrinsics{640, 480, 481.2, 480, 319.5, 239.5}, Intrinsics{739, 458, 726, 726, 354.6, 186.5},
        Intrinsics{1242, 375, 721.5, 721.5, 609.6, 172.9}, Intrinsics{512, 512, 252, 252, 258, 261},
        Intrinsics{80, 60, 65, 65, 39.5, 29.5}})
    CHECK(all(implausible(k)) == "");
}

TEST_CASE("intrinsics of another image size, a centre outside, swapped numbers: named, with the value") {
  CHECK(contains(all(implausible({320, 240, 517, 517, 318.6, 255.3})),
                 "cx 318.6 lies far from the middle of the image of width 320 (its middle is 159.5); do the "
                 "intrinsics belong to images "
                 "of width 638?"));
  CHECK(contains(all(implausible({320, 240, 517, 517, 318.6, 255.3})),
                 "cy 255.3 lies outside the image of height 240"));
  CHECK(contains(all(implausible({640, 480, 51, 52, 319.5, 239.5})),
                 "fx 51 for a width of 640 pixels is a field of view of 162 degrees"));
  CHECK(contains(all(implausible({640, 480, 5170, 5165, 319.5, 239.5})), "field of view of 7 degrees"));
  CHECK(contains(all(implausible({640, 480, 525, 525, 239.5, 319.5})), "cx 239.5 and cy 319.5 look swapped"));
  CHECK(contains(all(implausible({640, 480, 525, 250, 319.5, 239.5})), "a shape of 1 : 2.1"));
  CHECK(contains(all(implausible({640, 480, 0, 525, 319.5, 239.5})), "are no camera's"));
  CHECK(contains(all(implausible({640, 480, -525, 525, 319.5, 239.5})), "are no camera's"));
}

TEST_CASE("depths of a room are plausible, those of a wrong unit are not, and the likely one is named") {
  CHECK(all(implausible(room(1), 0.001, {})) == "");
  CHECK(all(implausible(room(0.2), 0.001, {})) == "");  // a table seen from near
  const std::string small = all(implausible(room(0.02), 1.0 / 50000, {}));
  CHECK(contains(small,
                 "half of the depths are nearer than 0.036 m, 1 to 99 % of the depths are 0.012 to 0.084 m"));
  CHECK(contains(small, "depth_unit is 1/50000 m; do the files use 1/1000"));
  CHECK(contains(all(implausible(room(50), 0.05, {})), "farther than 90 m"));
  DepthRange far = room(5);
  far.beyond = 0.8;
  CHECK(contains(all(implausible(far, 0.005, {5, 100})), "80 % of the depths lie beyond depth_max, 5 m"));
  // A unit that is five times too large: a wall at 20 m that no Kinect sees.
  CHECK(contains(all(implausible(room(5), 0.001, {})), "3 to 21 m, farther than such a sensor measures"));
  CHECK(contains(all(implausible(room(5), 0.001, {})), "do the files use 1/5000"));
  CHECK(all(implausible(room(5), 0.001, {0, 100})) == "");
  DepthRange empty = room(1);
  empty.holes = 0.99;
  CHECK(contains(all(implausible(empty, 0.001, {})), "99.0 % of the pixels have no depth"));
  DepthRange full = room(1);
  full.far = 65.535;
  CHECK(
      contains(all(implausible(full, 0.001, {0, 100})), "65.53 m, the largest number that the images hold"));
}

TEST_CASE("depths are counted in any range") {
  DepthHistogram histogram;
  CHECK_FALSE(histogram.range(5));
  cv::Mat depth(40, 40, CV_32FC1, cv::Scalar(2));
  depth.colRange(0, 10).setTo(0);
  depth.colRange(30, 40).setTo(8);
  histogram.add(depth);
  const auto range = histogram.range(5);
  REQUIRE(range);
  CHECK(histogram.pixels() == 400);
  CHECK(range->near == doctest::Approx(2).epsilon(0.03));
  CHECK(range->median == doctest::Approx(2).epsilon(0.03));
  CHECK(range->far == doctest::Approx(8).epsilon(0.03));
  CHECK(range->holes == doctest::Approx(0.25));
  CHECK(range->beyond == doctest::Approx(1.0 / 3));
  CHECK(histogram.range(0)->beyond == 0);
}
