#include "engine/slam/spawn.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/slam/birth_cells.h"
#include "engine/slam/surface_normal.h"
#include "engine/types/error.h"
#include "engine/types/median.h"

namespace surefield {

namespace {

constexpr double kMostStretch = 2;               // of a disc on a surface seen at a slant
constexpr float kShBase = 0.28209479177387814f;  // the SH basis function of degree 0

/// Median of |rendered - sensor depth| where both are known and the map is opaque; 0 where nothing is.
double median_depth_error(const Frame& frame, const RenderImages& rendered, const SpawnSettings& settings) {
  std::vector<float> errors;
  for (int i = 0; i < rendered.width * rendered.height; ++i) {
    const float sensor = frame.depth.at<float>(i / rendered.width, i % rendered.width);
    if (sensor > 0 && rendered.opacity[i] >= settings.opacity_below)
      errors.push_back(std::abs(rendered.depth_normalised[i] - sensor));
  }
  if (errors.empty()) return 0;
  return median(std::move(errors));
}

/// The shape of a newborn: standard deviations along its axes, metres, and their rotation.
struct BirthShape {
  Eigen::Vector3d scales;
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

/// A disc on the surface of this normal, seen along `ray`, that covers as much of the image in every
/// direction as a sphere of this radius; without a normal, the sphere. Both vectors in the camera frame.
BirthShape birth_shape(const Eigen::Vector3d& ray, const Eigen::Vector3d& normal, double radius,
                       const SpawnSettings& settings) {
  BirthShape shape{Eigen::Vector3d::Constant(radius)};
  if (settings.thickness >= 1 || normal.isZero()) return shape;
  const double cosine = std::abs(normal.dot(ray.normalized()));
  const Eigen::Vector3d across = normal.cross(ray);
  Eigen::Matrix3d axes;
  axes.col(0) = (across.norm() > 1e-6 * ray.norm() ? across : normal.unitOrthogonal()).normalized();
  axes.col(2) = normal;
  axes.col(1) = axes.col(2).cross(axes.col(0));  // the direction in which the surface recedes
  const double stretch = std::min(1 / std::max(cosine, 1e-3), kMostStretch);
  shape.scales = radius * Eigen::Vector3d(1, stretch, settings.thickness);
  shape.rotation = Eigen::Quaterniond(axes);
  return shape;
}

/// Flags of the pixels that give birth: the map is thin there, or lies far behind.
std::vector<uint8_t> birth_pixels(const Frame& frame, const RenderImages* rendered,
                                  const SpawnSettings& settings) {
  const double margin = rendered ? settings.front_factor * median_depth_error(frame, *rendered, settings) : 0;
  std::vector<uint8_t> flags(frame.depth.total());
  for (std::size_t i = 0; i < flags.size(); ++i) {
    const float z = frame.depth.ptr<float>()[i];
    if (!(z > 0)) continue;
    const bool empty = !rendered || rendered->opacity[i] < settings.opacity_below;
    const bool in_front = rendered && margin > 0 && rendered->depth_normalised[i] - z > margin;
    flags[i] = empty || in_front;
  }
  return flags;
}

/// Mean depth, metres, and colour, 0 to 255, of a cell.
std::pair<double, cv::Vec3d> mean_of(const Frame& frame, const BirthCell& cell) {
  double depth = 0;
  cv::Vec3d colour(0, 0, 0);
  for (int v = cell.v; v < cell.v + cell.size; ++v)
    for (int u = cell.u; u < cell.u + cell.size; ++u) {
      depth += frame.depth.at<float>(v, u);
      colour += frame.colour.at<cv::Vec3b>(v, u);
    }
  const double count = cell.size * cell.size;
  return {depth / count, colour / count};
}

}  // namespace

double scene_extent(const Frame& frame) {
  std::vector<float> depths;
  for (int v = 0; v < frame.depth.rows; ++v)
    for (int u = 0; u < frame.depth.cols; ++u)
      if (frame.depth.at<float>(v, u) > 0) depths.push_back(frame.depth.at<float>(v, u));
  if (depths.empty()) throw InputError("the first frame has no valid depth: all of its depth image is 0");
  const auto at = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() * 9 / 10);
  std::nth_element(depths.begin(), at, depths.end());
  return *at;
}

GaussianCloud spawn_gaussians(const Frame& frame, const Camera& camera, const RenderImages* rendered,
                              const SpawnSettings& settings, const Eigen::Vector3f& gains) {
  const Intrinsics& k = camera.intrinsics;
  const Pose camera_to_world = camera.world_to_camera.inverse();
  const auto logit = static_cast<float>(std::log(settings.opacity / (1 - settings.opacity)));
  GaussianCloud cloud;
  for (const BirthCell& cell : birth_cells(frame, birth_pixels(frame, rendered, settings), settings.cell)) {
    const auto [z, rgb] = mean_of(frame, cell);
    const double half = (cell.size - 1) / 2.0;
    const Eigen::Vector3d point(z * (cell.u + half - k.cx) / k.fx, z * (cell.v + half - k.cy) / k.fy, z);
    cloud.means.push_back((camera_to_world * point).cast<float>());
    const Eigen::Vector3d normal = surface_normal(frame, k, cell.u + cell.size / 2, cell.v + cell.size / 2);
    const double radius = cell.size * settings.footprint * z * 2 / (k.fx + k.fy);
    const BirthShape shape = birth_shape(point, normal, radius, settings);
    cloud.log_scales.push_back(shape.scales.array().log().matrix().cast<float>());
    const Eigen::Quaternionf q((camera_to_world.rotation() * shape.rotation).cast<float>());
    cloud.rotations.emplace_back(q.w(), q.x(), q.y(), q.z());
    cloud.opacity_logits.push_back(logit);
    cloud.uncertainty.push_back(0.0f);
    cloud.sampling.push_back(static_cast<float>(z / std::sqrt(k.fx * k.fy)));
    cloud.anchors.push_back(0);
    for (int c = 0; c < 3; ++c)
      cloud.sh.push_back((gains[c] * static_cast<float>(rgb[c]) / 255 - 0.5f) / kShBase);
  }
  return cloud;
}

}  // namespace surefield
