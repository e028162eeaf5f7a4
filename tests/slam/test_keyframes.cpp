#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "engine/slam/keyframes.h"

using namespace surefield;

namespace {

const Intrinsics kIntrinsics{.width = 64, .height = 48, .fx = 60, .fy = 60, .cx = 31.5, .cy = 23.5};

/// A keyframe of a wall two metres away, seen from (x, 0, 0) and turned by `yaw` radians.
Keyframe keyframe(double x, double yaw = 0) {
  Frame frame;
  frame.depth = cv::Mat(48, 64, CV_32FC1, cv::Scalar(2.0));
  Pose camera_to_world = Pose::Identity();
  camera_to_world.translate(Eigen::Vector3d(x, 0, 0))
      .rotate(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()));
  return make_keyframe(frame, 0, {kIntrinsics, camera_to_world.inverse()}, sample_points(frame, kIntrinsics));
}

}  // namespace

TEST_CASE("sampled points leave out invalid depth and lie where the pixel looks") {
  Frame frame;
  frame.depth = cv::Mat(48, 64, CV_32FC1, cv::Scalar(2.0));
  CHECK(sample_points(frame, kIntrinsics).size() == 12);
  frame.depth.at<float>(8, 8) = 0;
  frame.depth.at<float>(8, 24) = NAN;
  const auto points = sample_points(frame, kIntrinsics);
  REQUIRE(points.size() == 10);
  CHECK(points[0].isApprox(Eigen::Vector3f(2 * (40 - 31.5f) / 60, 2 * (8 - 23.5f) / 60, 2)));
}

TEST_CASE("overlap is one for the same view, less to the side, none behind") {
  CHECK(overlap(keyframe(0), keyframe(0)) == 1);
  const double beside = overlap(keyframe(0), keyframe(1));
  CHECK(beside > 0.2);
  CHECK(beside < 0.8);
  CHECK(overlap(keyframe(0), keyframe(10)) == 0);
  CHECK(overlap(keyframe(0), keyframe(0, M_PI)) == 0);
  Keyframe blind = keyframe(0);
  blind.points.clear();
  CHECK(overlap(blind, keyframe(0)) == 0);
}

TEST_CASE("the window holds the current keyframe, the one before, and those of the best scores") {
  const std::vector<double> scores{0.8, 0, 0.7, 0.1, 1};
  const auto members = [&](const std::vector<int>& near, int size) {
    return select_window(4, near, size, [&](int k) { return scores[k]; });
  };
  const KeyframeWindow window = members({4, 3, 2, 1, 0}, 4);
  CHECK(window.members == std::vector<int>{0, 2, 3, 4});
  CHECK(window.fixed == 0);
  CHECK(members({4, 3, 2, 1, 0}, 3).members == std::vector<int>{0, 3, 4});
  CHECK(members({4, 3, 2, 1, 0}, 1).members == std::vector<int>{4});
  CHECK(members({4, 3, 2, 1}, 4).members == std::vector<int>{2, 3, 4});
  CHECK(members({4}, 4).members == std::vector<int>{4});
  // What has nothing in common is of no use.
  CHECK(members({4, 3, 1}, 4).members == std::vector<int>{3, 4});
}

TEST_CASE("the mapping order cycles through the window and visits the past") {
  const KeyframeWindow window{{2, 5, 6}, 2};
  std::mt19937 random(1), again(1);
  const std::vector<int> near{6, 5, 0, 1, 2, 4};
  const auto order = mapping_order(window, near, 23, 2, random);
  REQUIRE(order.size() == 23);
  CHECK(order == mapping_order(window, {0, 1, 2, 4, 5, 6}, 23, 2, again));
  CHECK(order[0] == 6);
  CHECK(std::count(order.begin(), order.end(), 6) == 5);
  for (int k : order) CHECK((k >= 0 && k < 7 && k != 3));
  CHECK(std::count_if(order.begin(), order.end(), [](int k) { return k != 2 && k != 5 && k != 6; }) == 8);
  CHECK(mapping_order({{0}, 0}, {0}, 3, 2, random) == std::vector<int>{0, 0, 0});
}

TEST_CASE("the nearest keyframes stand near the newest and see what it sees; it and the one before lead") {
  const std::vector<Keyframe> keyframes{keyframe(2),    keyframe(0, M_PI), keyframe(0.5), keyframe(0.5),
                                        keyframe(1, 1), keyframe(9),       keyframe(0)};
  CHECK(nearest_keyframes(keyframes, 10) == std::vector<int>{6, 5, 3, 2, 4, 0, 1});
  CHECK(nearest_keyframes(keyframes, 4) == std::vector<int>{6, 5, 3, 2});
  CHECK(nearest_keyframes(keyframes, 1) == std::vector<int>{6});
  CHECK(nearest_keyframes({keyframe(3)}, 4) == std::vector<int>{0});
  // Those that look alike come before those that are near.
  CHECK(nearest_keyframes(keyframes, 5, {1, 0}) == std::vector<int>{6, 5, 1, 0, 3});
  CHECK(nearest_keyframes(keyframes, 2, {1, 0}) == std::vector<int>{6, 5});
  CHECK(nearest_keyframes(keyframes, 3, {5}) == std::vector<int>{6, 5, 3});
}
