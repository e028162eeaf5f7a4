// Depth seen from another camera, on planes whose image can be computed by hand.
#include "engine/sources/depth_registration.h"

#include <cmath>

#include "engine/sources/layouts.h"
#include "engine/sources/open_dataset.h"
#include "tests/support/input_files.h"

using namespace surefield;

namespace {

/// A depth camera 4 cm to the left of a colour camera of another focal length.
DepthRegistration side_by_side(double colour_focal) {
  DepthRegistration cameras;
  cameras.depth = {64, 48, 60, 60, 31.5, 23.5};
  cameras.colour = {64, 48, colour_focal, colour_focal, 30, 25};
  cameras.depth_to_colour.translation() = Eigen::Vector3d(-0.04, 0.01, 0.02);
  return cameras;
}

/// Holes between two depths that differ by less than a tenth, in a row or in a column.
int pin_holes(const cv::Mat& depth) {
  int count = 0;
  for (int y = 1; y + 1 < depth.rows; ++y) {
    for (int x = 1; x + 1 < depth.cols; ++x) {
      const auto closed = [&](int dx, int dy) {
        const float a = depth.at<float>(y - dy, x - dx), b = depth.at<float>(y + dy, x + dx);
        return a > 0 && b > 0 && std::abs(a - b) < 0.1f * std::min(a, b);
      };
      if (depth.at<float>(y, x) == 0 && (closed(1, 0) || closed(0, 1))) ++count;
    }
  }
  return count;
}

}  // namespace

TEST_CASE("the same camera sees the same depth") {
  DepthRegistration same = side_by_side(60);
  same.colour = same.depth;
  same.depth_to_colour.setIdentity();
  cv::Mat depth(48, 64, CV_32FC1, cv::Scalar(1.5));
  depth(cv::Rect(10, 10, 20, 20)).setTo(0);
  depth(cv::Rect(40, 5, 8, 8)).setTo(0.8);
  CHECK(cv::norm(register_depth(depth, same), depth, cv::NORM_INF) < 1e-6);
}

TEST_CASE("a wall fills the area that it has for the other camera, without holes, larger or smaller") {
  for (double focal : {45.0, 60.0, 150.0}) {
    CAPTURE(focal);
    const DepthRegistration cameras = side_by_side(focal);
    const cv::Mat registered = register_depth(cv::Mat(48, 64, CV_32FC1, cv::Scalar(2.0)), cameras);
    // The left border of the wall: x = (-0.5 - 31.5) / 60 * 2 m, then 4 cm to the left, at 2.02 m.
    const auto edge = [&](double pixel, double centre, double offset, double other) {
      return focal * ((pixel - centre) / 60 * 2 + offset) / 2.02 + other;
    };
    const double left = edge(-0.5, 31.5, -0.04, 30), right = edge(63.5, 31.5, -0.04, 30);
    const double top = edge(-0.5, 23.5, 0.01, 25), bottom = edge(47.5, 23.5, 0.01, 25);
    for (int y = 0; y < 48; ++y) {
      for (int x = 0; x < 64; ++x) {
        const bool seen = x > left && x < right && y > top && y < bottom;
        const bool near_border = std::min({std::abs(x - left), std::abs(x - right), std::abs(y - top),
                                           std::abs(y - bottom)}) < 1e-6;
        if (near_border) continue;
        CHECK(registered.at<float>(y, x) == doctest::Approx(seen ? 2.02 : 0.0));
      }
    }
  }
}

TEST_CASE("of two surfaces the nearer one is seen") {
  const DepthRegistration cameras = side_by_side(60);
  cv::Mat depth(48, 64, CV_32FC1, cv::Scalar(3.0));
  depth(cv::Rect(20, 10, 20, 20)).setTo(1.0);
  const cv::Mat registered = register_depth(depth, cameras);
  // The square's pixels 20 to 39 move to u = 60 * ((x - 31.5) / 60 - 0.04) / 1.02 + 30.
  const auto moved = [](double x) { return 60 * ((x - 31.5) / 60 - 0.04) / 1.02 + 30; };
  const int first = static_cast<int>(std::ceil(moved(19.5))),
            last = static_cast<int>(std::floor(moved(39.5)));
  for (int x = first; x <= last; ++x) CHECK(registered.at<float>(20, x) == doctest::Approx(1.02));
  CHECK(registered.at<float>(20, first - 1) != doctest::Approx(1.02));
  CHECK(registered.at<float>(20, last + 1) != doctest::Approx(1.02));
}

TEST_CASE("a slanted surface is closed, an edge is not bridged") {
  const DepthRegistration cameras = side_by_side(60);
  cv::Mat depth(48, 64, CV_32FC1);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) depth.at<float>(y, x) = 0.5f + 0.02f * static_cast<float>(x);
  }
  CHECK(pin_holes(register_depth(depth, cameras)) == 0);
  depth.colRange(0, 32).setTo(4.0);
  depth.colRange(32, 64).setTo(0.5);
  const cv::Mat registered = register_depth(depth, cameras);
  for (int x = 0; x < 64; ++x) {
    const float z = registered.at<float>(24, x);
    CHECK((z == 0 || std::abs(z - 4.02f) < 1e-4f || std::abs(z - 0.52f) < 1e-4f));
  }
}

TEST_CASE("7-Scenes' registered depth has no more pin holes than the sensor's") {
  const auto folder = test::real_clip("sevenscenes_redkitchen");
  if (folder.empty()) return;
  StoredSequence sequence = read_sevenscenes_sequence(folder);
  const FileRecording registered(sequence);
  sequence.intrinsics = sequence.registration->depth;
  sequence.registration.reset();
  const FileRecording stored(sequence);
  const int before = pin_holes(stored.load(0).frame->depth),
            after = pin_holes(registered.load(0).frame->depth);
  CAPTURE(before);
  CAPTURE(after);
  CHECK(after <= before);
}

TEST_CASE("trajectories of the tracked camera and of the reference camera turn into each other") {
  const auto folder = test::real_clip("sevenscenes_redkitchen");
  if (folder.empty()) return;
  const auto dataset = open_dataset(folder);
  const Trajectory& truth = *dataset.ground_truth;
  const Trajectory tracked = of_tracked_camera(truth, *dataset.recording);
  const Trajectory back = of_reference_camera(tracked, *dataset.recording);
  for (std::size_t i : {std::size_t{0}, truth.size() - 1}) {
    CHECK(back[i].camera_to_world.isApprox(truth[i].camera_to_world, 1e-9));
    // The colour camera sits 2.6 cm beside the depth camera, along the depth camera's +x.
    const Eigen::Vector3d offset =
        truth[i].camera_to_world.inverse() * tracked[i].camera_to_world.translation();
    CHECK(offset.x() == doctest::Approx(0.0256).epsilon(0.01));
    CHECK(std::abs(offset.y()) < 1e-3);
  }
}
