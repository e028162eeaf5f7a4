#include <doctest/doctest.h>

#include <cmath>

#include "engine/eval/pose_track.h"

using namespace surefield;

namespace {

StampedPose pose_at(double timestamp, double x, double radians = 0) {
  StampedPose pose{.timestamp = timestamp};
  pose.camera_to_world.translation().x() = x;
  pose.camera_to_world.linear() = Eigen::AngleAxisd(radians, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

}  // namespace

TEST_CASE("a track has the poses that it was given, in any order, and those between neighbours") {
  const PoseTrack track({pose_at(2, 4, 0.4), pose_at(1, 2), pose_at(3, 4, 0.4)});
  REQUIRE(track.at(1));
  CHECK(track.at(1)->translation().x() == 2);
  const auto between = track.at(1.25);
  REQUIRE(between);
  CHECK(between->translation().x() == doctest::Approx(2.5));
  CHECK(Eigen::AngleAxisd(between->linear()).angle() == doctest::Approx(0.1));
  CHECK(track.spacing() == 1);
}

TEST_CASE(
    "a track knows nothing before its first pose, after its last, in a gap, and of a camera that was lost") {
  StampedPose lost = pose_at(3, 99);
  lost.lost = true;
  StampedPose unknown = pose_at(4, 99);
  unknown.camera_to_world.translation().x() = NAN;
  const PoseTrack track(
      {pose_at(1, 0), pose_at(2, 1), lost, unknown, pose_at(5, 4), pose_at(6, 5), pose_at(30, 29)});
  CHECK_FALSE(track.at(0.9));
  CHECK_FALSE(track.at(30.1));
  CHECK_FALSE(track.at(20));
  REQUIRE(track.at(3));
  CHECK(track.at(3)->translation().x() == doctest::Approx(2));
  CHECK_FALSE(PoseTrack().at(0));
  CHECK(PoseTrack().empty());
}
