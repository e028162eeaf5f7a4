// The motion between two frames, told by their features alone.
#include "engine/places/rigid_match.h"

#include <doctest/doctest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "engine/synth/random.h"

using namespace surefield;

namespace {

/// A descriptor that no other is like.
FeatureBytes any_descriptor(RandomStream& random) {
  LocalFeatures descriptor(1, kFeatureSize);
  for (int i = 0; i < kFeatureSize; ++i) descriptor(0, i) = static_cast<float>(random.uniform(0, 1));
  return to_bytes(descriptor.normalized());
}

Pose some_pose() {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  pose.translation() = Eigen::Vector3d(0.4, -0.2, 0.6);
  return pose;
}

struct Two {
  PlacedFeatures from, to;
};

/// `count` points seen from both, of which every third is matched wrongly: it is elsewhere in the second.
Two see(int count, uint32_t seed, bool outliers = true) {
  RandomStream random(seed);
  Two two{{FeatureBytes(count, kFeatureSize), {}}, {FeatureBytes(count, kFeatureSize), {}}};
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d point(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(1, 3));
    const Eigen::Vector3d error(random.uniform(-0.004, 0.004), random.uniform(-0.004, 0.004),
                                random.uniform(-0.004, 0.004));
    Eigen::Vector3d other = some_pose() * point + error;
    if (outliers && i % 3 == 1) other += Eigen::Vector3d(random.uniform(0.2, 1), random.uniform(-1, 1), 0.3);
    two.from.descriptors.row(i) = two.to.descriptors.row(i) = any_descriptor(random);
    two.from.points.push_back(point.cast<float>());
    two.to.points.push_back(other.cast<float>());
  }
  return two;
}

const DepthNoise kNoise = noise_of(DepthSensor::StructuredLight);

}  // namespace

TEST_CASE("the motion between two frames is found where a third of the matches are wrong") {
  const Two two = see(90, 3);
  const auto match = match_rigidly(two.from, two.to, kNoise, 15);
  REQUIRE(match);
  CHECK(match->matches == 90);
  CHECK(match->inliers >= 58);
  CHECK(match->inliers <= 62);
  const Pose error = match->from_to * some_pose().inverse();
  CHECK(error.translation().norm() < 0.004);
  CHECK(Eigen::AngleAxisd(error.rotation()).angle() < 0.004);
}

TEST_CASE("no motion is told where too little agrees") {
  const Two two = see(18, 4);  // twelve right ones
  CHECK(match_rigidly(two.from, two.to, kNoise, 11));
  CHECK_FALSE(match_rigidly(two.from, two.to, kNoise, 15));
  CHECK_FALSE(match_rigidly(see(40, 5).from, see(40, 6).to, kNoise, 10));
  const PlacedFeatures none{FeatureBytes(0, kFeatureSize), {}};
  CHECK_FALSE(match_rigidly(none, none, kNoise, 0));
  CHECK_FALSE(match_rigidly(two.from, none, kNoise, 0));
  CHECK_FALSE(match_rigidly(none, two.to, kNoise, 0));
  // One feature, or the same place again and again, is no motion either.
  const Two one = see(1, 7, false);
  CHECK_FALSE(match_rigidly(one.from, one.to, kNoise, 0));
}

TEST_CASE("features get places where the depth about them is smooth, in images of any size") {
  const int width = 640, height = 480;
  cv::Mat colour(height, width, CV_8UC3, cv::Scalar(90, 90, 90));
  RandomStream random(9);
  for (int i = 0; i < 120; ++i)
    cv::circle(colour, {random.index(width), random.index(height)}, 6 + random.index(20),
               cv::Scalar(random.index(256), random.index(256), random.index(256)), cv::FILLED);
  Frame frame{.colour = colour, .depth = cv::Mat(height, width, CV_32FC1, cv::Scalar(2))};
  frame.depth(cv::Rect(0, 0, width / 2, height)).setTo(0);
  const Intrinsics intrinsics{
      .width = width, .height = height, .fx = 500, .fy = 510, .cx = 319.5, .cy = 239.5};
  const PlacedFeatures placed = place_features(frame, intrinsics);
  REQUIRE(placed.points.size() > 20);
  CHECK(placed.descriptors.rows() == static_cast<Eigen::Index>(placed.points.size()));
  for (const Eigen::Vector3f& point : placed.points) {
    CHECK(point.z() == 2);
    const double u = 500 * point.x() / point.z() + 319.5;
    CHECK(u > width / 2 - 1);
    CHECK(u < width);
  }
  // The same image shifted shows the same features shifted, though they are looked for in smaller images.
  cv::Mat shift = (cv::Mat_<double>(2, 3) << 1, 0, -40, 0, 1, 24), moved;
  cv::warpAffine(colour, moved, shift, colour.size());
  frame.depth.setTo(2);
  const PlacedFeatures before = place_features(frame, intrinsics);
  const PlacedFeatures after = place_features({.colour = moved, .depth = frame.depth}, intrinsics);
  const auto match = match_rigidly(before, after, kNoise, 30);
  REQUIRE(match);
  CHECK((match->from_to.translation() - Eigen::Vector3d(-40 * 2 / 500.0, 24 * 2 / 510.0, 0)).norm() < 0.004);
  CHECK(place_features({.colour = cv::Mat::zeros(height, width, CV_8UC3), .depth = frame.depth}, intrinsics)
            .points.empty());
}
