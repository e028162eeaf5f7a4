#include "engine/slam/depth_agreement.h"

#include <doctest/doctest.h>

#include "tests/slam/board_view.h"

using namespace surefield;
using testing::BoardView;
using testing::kBoardNoise;
using testing::kPerson;

TEST_CASE("two views of one wall agree wherever both see it") {
  const BoardView one(0), other(0.8);
  const DepthAgreement found = compare_depth(one.depth(), other.depth(), kBoardNoise);
  // At 3 m the image is 160 / 130 * 3 = 3.7 m wide.
  CHECK(found.shared == doctest::Approx(1 - 0.8 / 3.7).epsilon(0.05));
  CHECK(found.agreeing == 1);
  CHECK(found.seen_through == 0);
}

TEST_CASE("what only one shows is seen through by the other, either way") {
  const BoardView empty(0), with_person(0.1, {kPerson});
  for (const auto& [a, b] : {std::pair(&empty, &with_person), std::pair(&with_person, &empty)}) {
    const DepthAgreement found = compare_depth(a->depth(), b->depth(), kBoardNoise);
    CHECK(found.seen_through > 0.1);
    CHECK(found.agreeing < 0.9);
  }
}

TEST_CASE("what stands before something in one view hides it, and is not seen through") {
  const BoardView left(-0.4, {kPerson}), right(0.4, {kPerson});
  const DepthAgreement found = compare_depth(left.depth(), right.depth(), kBoardNoise);
  CHECK(found.seen_through < 0.02);
  CHECK(found.agreeing > 0.5);
  CHECK(found.agreeing < 0.95);
}

TEST_CASE("views that look elsewhere share nothing, and nothing is said of images without depth") {
  const BoardView here(0), far(50);
  const DepthAgreement apart = compare_depth(here.depth(), far.depth(), kBoardNoise);
  CHECK(apart.shared == 0);
  CHECK(apart.agreeing == 0);
  BoardView blind(0);
  std::fill(blind.grid.depth.begin(), blind.grid.depth.end(), 0.0f);
  CHECK(compare_depth(here.depth(), blind.depth(), kBoardNoise).agreeing == 0);
  CHECK(compare_depth(blind.depth(), blind.depth(), kBoardNoise).shared == 0);
  CHECK(median_shift(blind.depth(), Pose::Identity()) == 0);
}

TEST_CASE("a step to the side moves a wall by focal length times step over depth") {
  const BoardView view(0);
  Pose corrected = view.camera.world_to_camera;
  CHECK(median_shift(view.depth(), corrected) == doctest::Approx(0));
  corrected.translation().x() += 0.03;
  CHECK(median_shift(view.depth(), corrected) == doctest::Approx(130 * 0.03 / 3).epsilon(1e-3));
}
