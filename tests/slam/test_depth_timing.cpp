#include <doctest/doctest.h>

#include "engine/slam/depth_timing.h"

using namespace surefield;

namespace {

const Intrinsics kIntrinsics{.width = 65, .height = 49, .fx = 60, .fy = 58, .cx = 31.2, .cy = 24.1};

Pose small_motion() {
  return Eigen::Translation3d(0.01, -0.006, 0.008) *
         Pose(Eigen::AngleAxisd(0.01, Eigen::Vector3d(1, 2, -1).normalized()));
}

/// What a camera sees of the plane n . X = d that is given in the frame of another, from which `to_camera`
/// leads to it.
cv::Mat see_plane(const Eigen::Vector3d& n, double d, const Pose& to_camera) {
  const Eigen::Vector3d own = to_camera.linear() * n;
  const double distance = d + own.dot(to_camera.translation());
  cv::Mat depth(kIntrinsics.height, kIntrinsics.width, CV_32FC1);
  for (int v = 0; v < depth.rows; ++v)
    for (int u = 0; u < depth.cols; ++u)
      depth.at<float>(v, u) =
          static_cast<float>(distance / own.dot(Eigen::Vector3d((u - kIntrinsics.cx) / kIntrinsics.fx,
                                                                (v - kIntrinsics.cy) / kIntrinsics.fy, 1)));
  return depth;
}

bool is_inner(const cv::Mat& depth, int u, int v) {
  return u >= 3 && v >= 3 && u < depth.cols - 3 && v < depth.rows - 3;
}

}  // namespace

TEST_CASE("depth that was taken before colour moves on with the camera, later one back") {
  const CameraMotion motion{small_motion(), 0.03};
  CHECK(depth_to_colour(-0.03, motion).isApprox(small_motion(), 1e-12));
  CHECK(depth_to_colour(0, motion).isApprox(Pose::Identity(), 1e-12));
  CHECK(depth_to_colour(-0.03, {small_motion(), 0}).isApprox(Pose::Identity(), 1e-12));
  const Pose third = depth_to_colour(-0.01, motion);
  CHECK((third * third * third).isApprox(small_motion(), 1e-3));
  CHECK((depth_to_colour(0.03, motion) * small_motion()).isApprox(Pose::Identity(), 1e-3));
}

TEST_CASE("the shift of an image is that of its corners, at the median depth") {
  const cv::Mat depth(49, 65, CV_32FC1, cv::Scalar(2));
  CHECK(largest_shift(depth, kIntrinsics, Pose::Identity()) == doctest::Approx(0));
  CHECK(largest_shift(depth, kIntrinsics, Pose(Eigen::Translation3d(0.02, 0, 0))) == doctest::Approx(0.6));
  CHECK(largest_shift(cv::Mat::zeros(49, 65, CV_32FC1), kIntrinsics, small_motion()) == 0);
}

TEST_CASE("the depth of a slanted plane, moved, is what the camera sees from there") {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.2, 1).normalized();
  const cv::Mat moved = move_depth(see_plane(normal, 1.8, Pose::Identity()), kIntrinsics, small_motion());
  const cv::Mat expected = see_plane(normal, 1.8, small_motion());
  double largest = 0, unmoved = 0;
  for (int v = 0; v < moved.rows; ++v)
    for (int u = 0; u < moved.cols; ++u) {
      if (!is_inner(moved, u, v)) continue;
      largest = std::max<double>(largest, std::abs(moved.at<float>(v, u) - expected.at<float>(v, u)));
      const float before = see_plane(normal, 1.8, Pose::Identity()).at<float>(v, u);
      unmoved = std::max<double>(unmoved, std::abs(before - expected.at<float>(v, u)));
    }
  CHECK(unmoved > 0.01);
  CHECK(largest < 2e-5);
}

TEST_CASE("moved depth mixes no two surfaces, invents nothing and leaves its input alone") {
  cv::Mat depth = see_plane({0, 0, 1}, 3, Pose::Identity());
  depth.colRange(20, 40) = 1.0f;
  depth.rowRange(0, 6) = 0.0f;
  const cv::Mat before = depth.clone();
  const cv::Mat moved = move_depth(depth, kIntrinsics, small_motion());
  CHECK(cv::norm(depth, before, cv::NORM_INF) == 0);
  for (int v = 0; v < moved.rows; ++v)
    for (int u = 0; u < moved.cols; ++u) {
      const float z = moved.at<float>(v, u);
      CHECK((z == 0 || std::abs(z - 1) < 0.05f || std::abs(z - 3) < 0.05f));
      if (v < 4) CHECK(z == 0);
    }
  CHECK(cv::countNonZero(moved) > 0.8 * cv::countNonZero(depth));
}

TEST_CASE("depth that is not moved stays as it is; an image of no or one pixel too") {
  const cv::Mat depth = see_plane(Eigen::Vector3d(0.3, -0.2, 1).normalized(), 1.8, Pose::Identity());
  CHECK(cv::norm(move_depth(depth, kIntrinsics, Pose::Identity()), depth, cv::NORM_INF) < 1e-5);
  CHECK(move_depth(cv::Mat(0, 0, CV_32FC1), kIntrinsics, Pose::Identity()).empty());
  const Intrinsics one{.width = 1, .height = 1, .fx = 1, .fy = 1, .cx = 0, .cy = 0};
  const cv::Mat pixel(1, 1, CV_32FC1, cv::Scalar(2));
  CHECK(move_depth(pixel, one, Pose::Identity()).at<float>(0, 0) == 2.0f);
  CHECK(move_depth(pixel, one, Pose(Eigen::Translation3d(0, 9, 3))).at<float>(0, 0) == 0);
  CHECK(move_depth(pixel, one, Pose(Eigen::Translation3d(0, 0, 1))).at<float>(0, 0) == 3.0f);
}
