#include <doctest/doctest.h>

#include <algorithm>
#include <optional>

#include "engine/slam/moved_things.h"
#include "tests/slam/board_view.h"

using namespace surefield;
using testing::Board;
using View = testing::BoardView;

namespace {

std::vector<uint8_t> moved(const View& keyframe, const View& other) {
  const DepthView others[] = {other.depth()};
  return moved_cells(keyframe.depth(), others, testing::kBoardNoise);
}

}  // namespace

TEST_CASE(
    "what stands where another keyframe looked through has moved, whichever came first; what it hides has "
    "not") {
  const View before(0), after(0.25, {testing::kPerson});
  const std::vector<uint8_t> cells = moved(after, before);
  REQUIRE(cells.size() == after.grid.depth.size());
  int person = 0, rest = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const bool is_person = after.grid.depth[i] < 2;
    person += is_person;
    if (is_person)
      CHECK(cells[i] == 1);
    else
      rest += cells[i];
  }
  CHECK(person > 100);
  CHECK(rest > 0);  // a rim of two cells
  CHECK(rest < 150);
  CHECK(moved(before, after).empty());
}

TEST_CASE(
    "nothing has moved in a scene at rest, seen from two places, nor where the other is blind or did not "
    "look") {
  const std::vector<Board> still{testing::kPerson, {0.5, 1, -0.5, 1, 2}, {-1.4, -1.36, -1, 1, 1.2}};
  CHECK(moved(View(0, still), View(0.4, still)).empty());
  CHECK(moved(View(0.4, still), View(0, still)).empty());
  View blind(0.1);
  std::fill(blind.grid.depth.begin(), blind.grid.depth.end(), 0.0f);
  CHECK(moved(View(0, {testing::kPerson}), blind).empty());
  CHECK(moved(View(0, {testing::kPerson}), View(30)).empty());
  CHECK(moved_cells(View(0, {testing::kPerson}).depth(), {}, testing::kBoardNoise).empty());
}

TEST_CASE("what is thin, small, or as near to what is behind as the sensor can tell, does not count") {
  CHECK(moved(View(0, {{-0.02, 0.02, -1, 1, 1.5}}), View(0.2)).empty());
  CHECK(moved(View(0, {{-0.05, 0.05, -0.05, 0.05, 1.5}}), View(0.2)).empty());
  CHECK(moved(View(0, {{-0.6, 0.6, -0.6, 0.6, 2.95}}), View(0.2)).empty());
  CHECK_FALSE(moved(View(0, {{-0.6, 0.6, -0.6, 0.6, 2.7}}), View(0.2)).empty());
}

TEST_CASE("cells are laid on all pixels, those beyond the last whole cell included") {
  ColourGrid grid;
  grid.width = 3, grid.height = 2, grid.cell = 4;
  const std::vector<uint8_t> pixels = pixels_of_cells({1, 0, 0, 0, 0, 1}, grid, {14, 9});
  REQUIRE(pixels.size() == 14 * 9);
  const auto at = [&](int u, int v) { return pixels[static_cast<std::size_t>(v) * 14 + u]; };
  CHECK(at(0, 0) == 1);
  CHECK(at(3, 3) == 1);
  CHECK(at(4, 3) == 0);
  CHECK(at(3, 4) == 0);
  CHECK(at(8, 4) == 1);
  CHECK(at(13, 8) == 1);
  CHECK(at(7, 8) == 0);
}
