#include "engine/eval/loop_metrics.h"

#include <doctest/doctest.h>

#include <numbers>

using namespace surefield;

namespace {

const Intrinsics kIntrinsics{.width = 64, .height = 48, .fx = 60, .fy = 60, .cx = 31.5, .cy = 23.5};

/// Before a wall 2 m away that runs along x.
PlaceView before_wall(double x) {
  Pose world_to_camera = Pose::Identity();
  world_to_camera.translation().x() = -x;
  return {{kIntrinsics, world_to_camera}, cv::Mat(48, 64, CV_32FC1, cv::Scalar(2))};
}

/// Along the wall and back: 0, 0.5, ... 6, ... 0.5, 0 m.
std::vector<PlaceView> there_and_back() {
  std::vector<PlaceView> views;
  for (int i = 0; i <= 12; ++i) views.push_back(before_wall(0.5 * i));
  for (int i = 11; i >= 0; --i) views.push_back(before_wall(0.5 * i));
  return views;
}

/// The true edge, off by so many metres to the side and so many degrees.
LoopEdge edge(const std::vector<PlaceView>& views, int from, int to, double metres = 0, double degrees = 0) {
  const Pose truth = views[to].camera.world_to_camera * views[from].camera.world_to_camera.inverse();
  Pose off = truth;
  off.linear() =
      Eigen::AngleAxisd(degrees * std::numbers::pi / 180, Eigen::Vector3d::UnitY()) * truth.linear();
  off.translation().y() += metres;
  return {from, to, off};
}

}  // namespace

TEST_CASE("a way back along a wall is one revisit, from ten keyframes back on") {
  const std::vector<PlaceView> views = there_and_back();
  const auto revisits = find_revisits(shared_on_return(views));
  REQUIRE(revisits.size() == 1);
  // Keyframe 12 + i stands where 12 - i stood. A camera sees 2.1 m of the wall, of which two that are 1.4 m
  // apart share three tenths.
  CHECK(revisits[0].first == 16);
  CHECK(revisits[0].last == 24);
  CHECK_FALSE(revisits[0].closed);
}

TEST_CASE("who stands still has not come back, and who has turned round in place has") {
  const std::vector<PlaceView> still(30, before_wall(0));
  CHECK(find_revisits(shared_on_return(still)).empty());
  std::vector<PlaceView> turning;
  for (int i = 0; i <= 36; ++i) {
    PlaceView view = before_wall(0);
    view.camera.world_to_camera.linear() =
        Eigen::AngleAxisd(i * std::numbers::pi / 18, Eigen::Vector3d::UnitY()).toRotationMatrix();
    // At other angles nothing is near enough to be measured.
    if (i > 1 && i < 35) view.depth.setTo(0);
    turning.push_back(view);
  }
  const auto revisits = find_revisits(shared_on_return(turning));
  REQUIRE(revisits.size() == 1);
  CHECK(revisits[0].last == 36);
}

TEST_CASE("revisits that something lies between are told apart") {
  const KeyframeTable shared{{}, {0}, {0.3, 0}, {0.4, 0, 0}, {0, 0.2, 0, 0}, {0, 0, 0.5, 0, 0}};
  const auto revisits = find_revisits(shared);
  REQUIRE(revisits.size() == 2);
  CHECK(revisits[0].first == 2);
  CHECK(revisits[0].last == 3);
  CHECK(revisits[1].first == 5);
  CHECK(find_revisits(shared, {.shared = 0.45}).size() == 1);
}

TEST_CASE("edges are right, between, or false by their distance from the truth") {
  const std::vector<PlaceView> views = there_and_back();
  const auto measure = [&](const LoopEdge& accepted) { return measure_loops(views, {accepted}); };
  for (const bool backwards : {false, true}) {
    CAPTURE(backwards);
    const int from = backwards ? 22 : 2, to = backwards ? 2 : 22;
    const LoopMetrics right = measure(edge(views, from, to, 0.045, 1.9));
    CHECK(right.closed == 1);
    CHECK(right.revisits[0].closed);
    CHECK(right.edges == 1);
    CHECK(right.right == 1);
    CHECK(right.wrong == 0);
    CHECK(right.largest == doctest::Approx(0.045));
    for (const auto& [metres, degrees] : {std::pair(0.055, 0.0), {0.0, 2.1}, {0.095, 4.9}}) {
      const LoopMetrics between = measure(edge(views, from, to, metres, degrees));
      CHECK(between.closed == 0);
      CHECK(between.right == 0);
      CHECK(between.wrong == 0);
    }
    for (const auto& [metres, degrees] : {std::pair(0.105, 0.0), {0.0, 5.1}}) {
      const LoopMetrics wrong = measure(edge(views, from, to, metres, degrees));
      CHECK(wrong.closed == 0);
      CHECK(wrong.wrong == 1);
    }
  }
}

TEST_CASE("an edge closes the revisit that it leads from, and only by leading back") {
  const std::vector<PlaceView> views = there_and_back();
  // To the keyframe just before, which is no loop, and from before the revisit.
  CHECK(measure_loops(views, {edge(views, 21, 22), edge(views, 2, 14)}).closed == 0);
  CHECK(measure_loops(views, {edge(views, 21, 22), edge(views, 2, 14)}).right == 2);
  CHECK(measure_loops(views, {edge(views, 2, 16)}).closed == 1);
  CHECK(measure_loops(views, {}).revisits.size() == 1);
}
