#include <doctest/doctest.h>

#include "engine/slam/surface_normal.h"

using namespace surefield;

namespace {

const Intrinsics kIntrinsics{.width = 32, .height = 24, .fx = 30, .fy = 28, .cx = 15.2, .cy = 12.1};

float plane_depth(const Eigen::Vector3d& normal, double distance, int u, int v) {
  const Eigen::Vector3d ray((u - kIntrinsics.cx) / kIntrinsics.fx, (v - kIntrinsics.cy) / kIntrinsics.fy, 1);
  return static_cast<float>(-distance / normal.dot(ray));
}

}  // namespace

TEST_CASE("the normal of a plane is the plane's, towards the camera, also beside an edge and at the border") {
  const Eigen::Vector3d left = Eigen::Vector3d(0.3, -0.4, -1).normalized(), right(0, 0, -1);
  Frame frame;
  frame.depth = cv::Mat(24, 32, CV_32FC1);
  for (int v = 0; v < 24; ++v)
    for (int u = 0; u < 32; ++u)
      frame.depth.at<float>(v, u) = u < 16 ? plane_depth(left, 1.2, u, v) : plane_depth(right, 3, u, v);
  const auto normal = [&](int u, int v) { return surface_normal(frame, kIntrinsics, u, v); };
  CHECK(normal(8, 12).isApprox(left, 1e-3));
  CHECK(normal(15, 12).isApprox(left, 1e-3));
  CHECK(normal(0, 8).isApprox(left, 1e-3));
  CHECK(normal(16, 12).isApprox(right, 1e-3));
  CHECK(normal(31, 12).isApprox(right, 1e-3));
}

TEST_CASE("there is no normal without depth, and from too few pixels or a line") {
  Frame frame;
  frame.depth = cv::Mat(24, 32, CV_32FC1, cv::Scalar(0));
  CHECK(surface_normal(frame, kIntrinsics, 3, 3).isZero());
  frame.depth.at<float>(10, 10) = 2;
  CHECK(surface_normal(frame, kIntrinsics, 10, 10).isZero());
  for (int u = 0; u < 32; ++u) frame.depth.at<float>(10, u) = 2;
  CHECK(surface_normal(frame, kIntrinsics, 10, 10).isZero());
  frame.depth.setTo(6);
  CHECK(surface_normal(frame, kIntrinsics, 10, 10).isApprox(Eigen::Vector3d(0, 0, -1)));
}
