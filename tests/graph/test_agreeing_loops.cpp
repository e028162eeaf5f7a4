// Which loops confirm each other.
#include "engine/graph/agreeing_loops.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "made_graphs.h"

using namespace surefield;
using namespace surefield::test;

namespace {

std::vector<bool> confirmed_in(const MadeGraph& made) {
  const auto loops = made.edges.begin() + made.odometry();
  return agreeing_loops({made.edges.begin(), loops}, {loops, made.edges.end()},
                        static_cast<int>(made.truth.size()));
}

}  // namespace

TEST_CASE("right loops confirm each other whatever the noise, false ones at random none") {
  for (const EdgeNoise& noise : {EdgeNoise{0.01, 0.01}, EdgeNoise{0.05, 0.1}}) {
    MadeGraph made = made_sphere(10, 30, noise);
    const auto right = static_cast<int>(made.edges.size()) - made.odometry();
    add_false_edges(made, 0.1);
    const std::vector<bool> confirmed = confirmed_in(made);
    CHECK(std::count(confirmed.begin(), confirmed.begin() + right, true) >= right - right / 100);
    CHECK(std::count(confirmed.begin() + right, confirmed.end(), true) <= 1);
  }
}

TEST_CASE("a loop alone is not confirmed, by one the other way round it is") {
  MadeGraph made = made_sphere(4, 10, {0.01, 0.01});
  made.edges.resize(made.odometry());
  const auto between = [&](int from, int to) {
    return RelativePose{from, to, made.truth[to] * made.truth[from].inverse(), made.edges[0].information};
  };
  made.edges.push_back(between(3, 30));
  CHECK(confirmed_in(made) == std::vector<bool>{false});
  MadeGraph far = made, twice = made;
  far.edges.push_back(between(10, 30));
  CHECK(confirmed_in(far) == std::vector<bool>{false, false});
  twice.edges.push_back(between(31, 1));
  CHECK(confirmed_in(twice) == std::vector<bool>{true, true});
  twice.edges.back().pose.translation().x() += 1;
  CHECK(confirmed_in(twice) == std::vector<bool>{false, false});
}
