#include "engine/slam/spawn.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "engine/io/median.h"

namespace surefield {

namespace {

constexpr float kShBase = 0.28209479177387814f;  // the SH basis function of degree 0

bool valid(float depth, double depth_max) {
  return depth > 0 && depth <= depth_max;
}

/// Median of |rendered - sensor depth| where both are known and the map is opaque; 0 where nothing is.
double median_depth_error(const Frame& frame, const RenderImages& rendered, const SpawnSettings& settings,
                          double depth_max) {
  std::vector<float> errors;
  for (int i = 0; i < rendered.width * rendered.height; ++i) {
    const float sensor = frame.depth.at<float>(i / rendered.width, i % rendered.width);
    if (valid(sensor, depth_max) && rendered.opacity[i] >= settings.opacity_below)
      errors.push_back(std::abs(rendered.depth_normalised[i] - sensor));
  }
  if (errors.empty()) return 0;
  return median(std::move(errors));
}

}  // namespace

double scene_extent(const Frame& frame, double depth_max) {
  std::vector<float> depths;
  for (int v = 0; v < frame.depth.rows; ++v)
    for (int u = 0; u < frame.depth.cols; ++u) {
      const float z = frame.depth.at<float>(v, u);
      if (z > 0 && z <= depth_max) depths.push_back(z);
    }
  if (depths.empty()) throw std::invalid_argument("the first frame has no valid depth");
  const auto at = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() * 9 / 10);
  std::nth_element(depths.begin(), at, depths.end());
  return *at;
}

GaussianCloud spawn_gaussians(const Frame& frame, const Camera& camera, const RenderImages* rendered,
                              const SpawnSettings& settings, double depth_max) {
  const Intrinsics& k = camera.intrinsics;
  const Pose camera_to_world = camera.world_to_camera.inverse();
  const double margin =
      rendered ? settings.front_factor * median_depth_error(frame, *rendered, settings, depth_max) : 0;
  const auto logit = static_cast<float>(std::log(settings.opacity / (1 - settings.opacity)));
  GaussianCloud cloud;
  for (int v = 0; v < k.height; ++v)
    for (int u = 0; u < k.width; ++u) {
      const float z = frame.depth.at<float>(v, u);
      if (!valid(z, depth_max)) continue;
      const std::size_t pixel = static_cast<std::size_t>(v) * k.width + u;
      const bool empty = !rendered || rendered->opacity[pixel] < settings.opacity_below;
      const bool in_front = rendered && margin > 0 && rendered->depth_normalised[pixel] - z > margin;
      if (!empty && !in_front) continue;
      const Eigen::Vector3d point(z * (u - k.cx) / k.fx, z * (v - k.cy) / k.fy, z);
      cloud.means.push_back((camera_to_world * point).cast<float>());
      const double radius = settings.footprint * z * 2 / (k.fx + k.fy);
      cloud.log_scales.push_back(Eigen::Vector3f::Constant(static_cast<float>(std::log(radius))));
      cloud.rotations.emplace_back(1.0f, 0.0f, 0.0f, 0.0f);
      cloud.opacity_logits.push_back(logit);
      cloud.uncertainty.push_back(0.0f);
      const cv::Vec3b& rgb = frame.colour.at<cv::Vec3b>(v, u);
      for (int c = 0; c < 3; ++c) cloud.sh.push_back((static_cast<float>(rgb[c]) / 255 - 0.5f) / kShBase);
    }
  return cloud;
}

}  // namespace surefield
