#include "engine/synth/sensor_model.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/synth/random.h"

namespace surefield {

using Eigen::Vector3d;

namespace {

constexpr double kJump = 0.35, kDouble = 2;  // of the light
constexpr double kFadeSeconds = 12.0 / 30;   // until the light is all there

constexpr uint32_t kDepthStream = 1u << 28, kColourStream = 2u << 28, kDriftStream = 3u << 28;

/// A normal variate of its own for each key (Box and Muller).
double gaussian(uint32_t seed, uint32_t stream, uint32_t pixel, uint32_t channel) {
  const double a = unit_interval(hash_key(seed, stream, pixel, 2 * channel)) + 0x1p-33;
  const double b = unit_interval(hash_key(seed, stream, pixel, 2 * channel + 1));
  return std::sqrt(-2 * std::log(a)) * std::cos(2 * std::numbers::pi * b);
}

Vector3d back_project(const cv::Mat& depth, const Intrinsics& k, int u, int v) {
  const double z = depth.at<float>(v, u);
  return {(u - k.cx) / k.fx * z, (v - k.cy) / k.fy * z, z};
}

/// Whether a pixel lies at an edge of depth, or on a surface that is seen at too flat an angle.
bool gives_no_echo(const KinectModel& model, const cv::Mat& depth, const Intrinsics& k, int u, int v) {
  const int left = std::max(u - 1, 0), right = std::min(u + 1, depth.cols - 1);
  const int up = std::max(v - 1, 0), down = std::min(v + 1, depth.rows - 1);
  const double z = depth.at<float>(v, u);
  for (const cv::Point& p : {cv::Point(left, v), cv::Point(right, v), cv::Point(u, up), cv::Point(u, down)})
    if (!(std::abs(depth.at<float>(p) - z) < model.edge_step * std::max(1.0, z / 2))) return true;
  const Vector3d across = back_project(depth, k, right, v) - back_project(depth, k, left, v);
  const Vector3d along = back_project(depth, k, u, down) - back_project(depth, k, u, up);
  const Vector3d normal = across.cross(along).normalized(), ray = back_project(depth, k, u, v).normalized();
  return !(std::abs(normal.dot(ray)) > model.grazing_cosine);
}

}  // namespace

cv::Mat KinectModel::depth(const cv::Mat& exact, const Intrinsics& k, int frame) const {
  cv::Mat measured = cv::Mat::zeros(exact.size(), CV_32FC1);
  const double native =
      native_width * k.fx / k.width * baseline / disparity_step;  // steps of disparity times depth
  const uint32_t stream = kDepthStream + static_cast<uint32_t>(frame);
  for (int v = 0; v < exact.rows; ++v) {
    for (int u = 0; u < exact.cols; ++u) {
      const double z = exact.at<float>(v, u);
      if (!(z >= nearest && z <= furthest) || gives_no_echo(*this, exact, k, u, v)) continue;
      const auto pixel = static_cast<uint32_t>(v * exact.cols + u);
      const double noisy = z + axial_sigma(z) * gaussian(seed, stream, pixel, 0);
      measured.at<float>(v, u) = static_cast<float>(native / std::round(native / noisy));
    }
  }
  return measured;
}

void KinectModel::add_colour_noise(cv::Mat& colour, int frame) const {
  const uint32_t stream = kColourStream + static_cast<uint32_t>(frame);
  for (int v = 0; v < colour.rows; ++v) {
    for (int u = 0; u < colour.cols; ++u) {
      auto& rgb = colour.at<cv::Vec3b>(v, u);
      const auto pixel = static_cast<uint32_t>(v * colour.cols + u);
      for (uint32_t c = 0; c < 3; ++c) {
        auto& value = rgb[static_cast<int>(c)];
        const double sigma = std::hypot(read_noise, shot_noise * std::sqrt(value));
        value = cv::saturate_cast<uchar>(value + sigma * gaussian(seed, stream, pixel, c));
      }
    }
  }
}

double KinectModel::brightness(double seconds) const {
  const double start = unit_interval(hash_key(seed, kDriftStream));
  const double drifting =
      1 + exposure_drift * std::sin(2 * std::numbers::pi * (seconds / drift_period + start));
  switch (course) {
    case ExposureCourse::Drift:
      return drifting;
    case ExposureCourse::Jump:
      return drifting * (seconds < jump_seconds ? 1 : kJump);
    case ExposureCourse::Double:
      return drifting * (seconds < jump_seconds ? 1 : kDouble);
    case ExposureCourse::FadeIn:
      return drifting * std::clamp(seconds / kFadeSeconds, 0.0, 1.0);
  }
  return drifting;
}

}  // namespace surefield
