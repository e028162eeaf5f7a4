#include "engine/eval/place_metrics.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace surefield;

namespace {

const Intrinsics kIntrinsics{.width = 64, .height = 48, .fx = 60, .fy = 60, .cx = 31.5, .cy = 23.5};

/// A view of a wall, so many metres away, from (x, 0, 0).
PlaceView view(double x, double depth = 2) {
  Pose world_to_camera = Pose::Identity();
  world_to_camera.translation().x() = -x;
  return {{kIntrinsics, world_to_camera}, cv::Mat(48, 64, CV_32FC1, cv::Scalar(depth))};
}

}  // namespace

TEST_CASE("views share what both see at the same depth") {
  CHECK(shared_view(view(0), view(0)) == 1);
  const double beside = shared_view(view(0), view(1));
  CHECK(beside > 0.4);
  CHECK(beside < 0.6);
  CHECK(shared_view(view(0), view(9)) == 0);
  // Something stands before the wall there, or it is seen through.
  CHECK(shared_view(view(0), view(0, 1.5)) == 0);
  CHECK(shared_view(view(0), view(0, 2.5)) == 0);
  CHECK(shared_view(view(0), view(0, 2.05)) == 1);
  PlaceView behind = view(0);
  behind.camera.world_to_camera.linear() = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()).matrix();
  CHECK(shared_view(view(0), behind) == 0);
}

TEST_CASE("where depth is missing nothing is said about what is shared") {
  PlaceView half = view(0);
  half.depth.colRange(0, 32).setTo(0);
  CHECK(shared_view(view(0), half) == 1);
  CHECK(shared_view(half, view(0)) == 1);
  half.depth.colRange(32, 64).setTo(1);
  CHECK(shared_view(view(0), half) == 0);
  half.depth.setTo(0);
  CHECK(shared_view(view(0), half) == 0);
  CHECK(shared_view(half, view(0)) == 0);
}

TEST_CASE("places count what was found of what there was to find, among those far enough before") {
  // The fifth keyframe shares with 0, 1 and 3; the last with nothing.
  const KeyframeTable shared{
      {1}, {0, 1}, {0, 0, 1}, {0, 0, 0, 1}, {0.5, 0.3, 0.1, 0.9, 1}, {0, 0, 0, 0, 0, 1}};
  KeyframeTable scores{{1}, {1, 1}, {1, 1, 1}, {1, 1, 1, 1}, {0.2, 0.1, 0.9, 1, 1}, {1, 1, 1, 1, 1, 1}};
  PlaceMetrics metrics = measure_places(scores, shared, {.count = 2, .gap = 2});
  CHECK(metrics.queries == 1);
  CHECK(metrics.found == doctest::Approx(0.5));  // 2 and 0 are looked up; 0 and 1 are right
  CHECK(metrics.recall == doctest::Approx(0.5));
  metrics = measure_places(scores, shared, {.count = 2, .gap = 1});
  CHECK(metrics.found == doctest::Approx(0.5));  // 3 and 2
  CHECK(metrics.recall == doctest::Approx(1.0 / 3));
  metrics = measure_places(scores, shared, {.count = 5, .gap = 2});
  CHECK(metrics.found == 1);  // there are but two to find
  metrics = measure_places(scores, shared, {.count = 1, .gap = 2, .shared = 0.4});
  CHECK(metrics.found == 0);
  // Without a score nothing is looked up, and of equals the more recent is.
  scores[4] = {0, 0, 0, 0, 0};
  CHECK(measure_places(scores, shared, {.count = 3}).recall == 0);
  scores[4] = {1, 1, 0, 1, 1};
  CHECK(measure_places(scores, shared, {.count = 1, .shared = 0.4}).found == 0);
  CHECK(measure_places(scores, shared, {.count = 1, .shared = 0.3}).found == 1);
  CHECK(std::isnan(measure_places(scores, shared, {.gap = 6}).found));
}
