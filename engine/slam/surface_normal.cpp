#include "engine/slam/surface_normal.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace surefield {

namespace {

constexpr int kRadius = 3;                 // of the neighbourhood, pixels
constexpr int kFewest = 17;                // neighbours that a plane is fitted to: a third of them
constexpr float kSameSurface = 0.05f;      // of the depth, between neighbours
constexpr double kLeastDeterminant = 1.0;  // of the pixels' second moments: less is next to a line

/// Sums for the fit of 1/z = a du + b dv + c.
struct PlaneFit {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  int count = 0;

  void add(int du, int dv, double inverse_depth) {
    const Eigen::Vector3d row(du, dv, 1);
    normal += row * row.transpose();
    right += inverse_depth * row;
    ++count;
  }
};

PlaneFit fit_around(const cv::Mat& depth, int u, int v) {
  PlaneFit fit;
  const float z = depth.at<float>(v, u);
  for (int dv = -kRadius; dv <= kRadius; ++dv)
    for (int du = -kRadius; du <= kRadius; ++du) {
      if (u + du < 0 || v + dv < 0 || u + du >= depth.cols || v + dv >= depth.rows) continue;
      const float other = depth.at<float>(v + dv, u + du);
      if (other > 0 && std::abs(other - z) < kSameSurface * z) fit.add(du, dv, 1 / other);
    }
  return fit;
}

}  // namespace

Eigen::Vector3d surface_normal(const Frame& frame, const Intrinsics& k, int u, int v) {
  const float z = frame.depth.at<float>(v, u);
  if (!(z > 0)) return Eigen::Vector3d::Zero();
  const PlaneFit fit = fit_around(frame.depth, u, v);
  if (fit.count < kFewest || fit.normal.determinant() < kLeastDeterminant) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d plane = fit.normal.ldlt().solve(fit.right);
  // n . X = 1 on the plane: 1/z = n . ((u - cx) / fx, (v - cy) / fy, 1).
  const double nx = plane.x() * k.fx, ny = plane.y() * k.fy;
  const Eigen::Vector3d n(nx, ny, plane.z() - nx * (u - k.cx) / k.fx - ny * (v - k.cy) / k.fy);
  return -n.normalized();
}

}  // namespace surefield
