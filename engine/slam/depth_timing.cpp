#include "engine/slam/depth_timing.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "engine/types/median.h"

namespace surefield {

namespace {

constexpr float kOneSurface = 0.02f;  // of the depth, by which neighbours on one surface differ at most
constexpr int kRoundsOfLookup = 2;

/// The depth at a place of the image: between four pixels where they show one surface, else that of the
/// nearest one; 0 where there is none.
float depth_at(const cv::Mat& depth, double u, double v) {
  if (!(u > -1 && v > -1 && u < depth.cols && v < depth.rows)) return 0;
  const int x = static_cast<int>(std::floor(u)), y = static_cast<int>(std::floor(v));
  const int nearest_x = static_cast<int>(std::lround(u)), nearest_y = static_cast<int>(std::lround(v));
  if (nearest_x < 0 || nearest_y < 0 || nearest_x >= depth.cols || nearest_y >= depth.rows) return 0;
  const float nearest = depth.at<float>(nearest_y, nearest_x);
  if (!(nearest > 0) || x < 0 || y < 0 || x + 1 >= depth.cols || y + 1 >= depth.rows) return nearest;
  const float* upper = depth.ptr<float>(y) + x;
  const float* lower = depth.ptr<float>(y + 1) + x;
  for (const float z : {upper[0], upper[1], lower[0], lower[1]})
    if (!(std::abs(z - nearest) < kOneSurface * nearest)) return nearest;
  const auto right = static_cast<float>(u - x), down = static_cast<float>(v - y);
  // Inverse depth is linear in the image on a plane.
  return 1 / ((1 - down) * ((1 - right) / upper[0] + right / upper[1]) +
              down * ((1 - right) / lower[0] + right / lower[1]));
}

/// The depth, once moved, of what the image shows where it shows `point`; 0 where that is nothing.
double depth_seen_at(const Eigen::Vector3d& point, const cv::Mat& depth, const Intrinsics& k,
                     const Pose& motion) {
  if (point.z() <= 0) return 0;
  const double u = k.fx * point.x() / point.z() + k.cx, v = k.fy * point.y() / point.z() + k.cy;
  const double z = depth_at(depth, u, v);
  if (z == 0) return 0;
  return (motion * Eigen::Vector3d(z * (u - k.cx) / k.fx, z * (v - k.cy) / k.fy, z)).z();
}

}  // namespace

Pose depth_to_colour(double depth_after, const CameraMotion& motion) {
  if (!(motion.seconds > 0)) return Pose::Identity();
  const double share = -depth_after / motion.seconds;
  const Eigen::AngleAxisd turn(motion.motion.rotation());
  Pose part = Pose::Identity();
  part.linear() = Eigen::AngleAxisd(share * turn.angle(), turn.axis()).toRotationMatrix();
  part.translation() = share * motion.motion.translation();
  return part;
}

cv::Mat move_depth(const cv::Mat& depth, const Intrinsics& k, const Pose& motion) {
  cv::Mat moved = cv::Mat::zeros(depth.size(), CV_32FC1);
  const Pose back = motion.inverse();
  for (int v = 0; v < depth.rows; ++v)
    for (int u = 0; u < depth.cols; ++u) {
      const Eigen::Vector3d ray((u - k.cx) / k.fx, (v - k.cy) / k.fy, 1);
      double z = depth.at<float>(v, u);
      for (int round = 0; round < kRoundsOfLookup && z > 0; ++round)
        z = depth_seen_at(back * (z * ray), depth, k, motion);
      moved.at<float>(v, u) = z > 0 ? static_cast<float>(z) : 0;
    }
  return moved;
}

double largest_shift(const cv::Mat& depth, const Intrinsics& k, const Pose& motion) {
  std::vector<float> depths;
  for (int v = 0; v < depth.rows; ++v)
    std::copy_if(depth.ptr<float>(v), depth.ptr<float>(v) + depth.cols, std::back_inserter(depths),
                 [](float z) { return z > 0; });
  if (depths.empty()) return 0;
  const double z = median(std::move(depths));
  double largest = 0;
  for (const double u : {0.0, k.width - 1.0})
    for (const double v : {0.0, k.height - 1.0}) {
      const Eigen::Vector3d p = motion * Eigen::Vector3d(z * (u - k.cx) / k.fx, z * (v - k.cy) / k.fy, z);
      largest =
          std::max(largest, std::hypot(k.fx * p.x() / p.z() + k.cx - u, k.fy * p.y() / p.z() + k.cy - v));
    }
  return largest;
}

}  // namespace surefield
