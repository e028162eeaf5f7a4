#include "tests/viewer/reference_picture.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tests/reference/projection.h"
#include "tests/reference/splatting.h"

namespace surefield::reference {

namespace {

using Eigen::Vector3d;
using Versions = std::vector<Vector3d>;

/// OpenCV's colours around a value in [0, 1].
Versions palette(double value, int map) {
  Versions versions;
  for (int off : {0, -1, 1}) {
    cv::Mat level(1, 1, CV_8UC1), bgr;
    level.at<uint8_t>(0) =
        static_cast<uint8_t>(std::clamp(std::lround(std::clamp(value, 0.0, 1.0) * 255) + off, 0L, 255L));
    cv::applyColorMap(level, bgr, map);
    const cv::Vec3b c = bgr.at<cv::Vec3b>(0);
    versions.push_back({double(c[2]), double(c[1]), double(c[0])});
  }
  return versions;
}

Versions over(Versions versions, double weight, const Vector3d& background) {
  for (Vector3d& v : versions) v = weight * v + (1 - weight) * 255 * background;
  return versions;
}

/// The Gaussians with these colours, the same from everywhere.
Gaussians coloured(Gaussians gaussians, const std::vector<Vector3d>& colours) {
  gaussians.sh_degree = 0;
  gaussians.sh.clear();
  for (const Vector3d& colour : colours)
    for (int c = 0; c < 3; ++c) gaussians.sh.push_back((colour[c] - 0.5) / 0.28209479177387814);
  return gaussians;
}

/// The shortest axes as colours.
std::vector<Vector3d> normals(const Gaussians& gaussians, const Camera& camera) {
  std::vector<Vector3d> colours;
  for (std::size_t i = 0; i < gaussians.size(); ++i) {
    const Eigen::Vector4d q = gaussians.rotations[i].normalized();
    int shortest = 0;
    gaussians.log_scales[i].minCoeff(&shortest);
    const Vector3d axis = camera.world_to_camera.linear() *
                          (Eigen::Quaterniond(q[0], q[1], q[2], q[3]) * Vector3d::Unit(shortest));
    const Vector3d n = axis.dot(camera.world_to_camera * gaussians.means[i]) > 0 ? Vector3d(-axis) : axis;
    colours.push_back((Vector3d(n.x(), -n.y(), -n.z()).array() + 1) / 2);
  }
  return colours;
}

/// A solid on the image: an ellipsoid in (u, v, z), whose covariance is known.
struct Solid {
  Vector3d centre;
  Eigen::Matrix3d form;  ///< x^T form x = 1 on its surface
  Vector3d colour;
};

std::vector<Solid> solids(const Gaussians& gaussians, const Camera& camera, bool dots) {
  std::vector<Solid> all;
  for (int i = 0; i < static_cast<int>(gaussians.size()); ++i) {
    const Projection p = project(gaussians, i, camera, {});
    if (p.decisions.culled || p.opacity < glsl::SOLID_OPACITY) continue;
    const Eigen::Vector4d q = gaussians.rotations[i].normalized();
    const Eigen::Matrix3d root = camera.world_to_camera.linear() *
                                 Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix() *
                                 gaussians.log_scales[i].array().exp().matrix().asDiagonal();
    Eigen::Matrix3d covariance;
    covariance << p.covariance, p.covariance * p.slope, (p.covariance * p.slope).transpose(),
        root.row(2).squaredNorm();
    Solid solid{{p.mean.x(), p.mean.y(), p.depth()},
                covariance.inverse() / (glsl::SOLID_RADIUS * glsl::SOLID_RADIUS),
                p.colour};
    // A dot is a disc: nearly nothing along z.
    if (dots)
      solid.form =
          Vector3d(1 / (glsl::DOT_RADIUS * glsl::DOT_RADIUS), 1 / (glsl::DOT_RADIUS * glsl::DOT_RADIUS), 1e12)
              .asDiagonal();
    all.push_back(solid);
  }
  return all;
}

/// The nearest solid at a pixel: z solves a quadratic equation.
Versions nearest_solid(const std::vector<Solid>& all, int u, int v, bool dots, const Vector3d& background,
                       uint8_t& edge) {
  double nearest = INFINITY;
  Vector3d colour = 255 * background;
  for (const Solid& s : all) {
    const Vector3d d(u - s.centre.x(), v - s.centre.y(), 0);
    const double a = s.form(2, 2), b = s.form.row(2).dot(d), c = d.dot(s.form * d) - 1;
    const double inside = (b * b - a * c) / a;  // 1 in the middle of its image, 0 at the rim
    if (std::abs(inside) < 1e-3) edge = 1;
    if (inside < 0) continue;
    const double z = s.centre.z() - (b + std::sqrt(b * b - a * c)) / a;
    if (std::abs(z - 0.01) < 1e-4 || std::abs(z - nearest) < 1e-4) edge = 1;
    if (z < 0.01 || z >= nearest) continue;
    nearest = z;
    colour = (255 * s.colour * (dots ? 1 : 0.3 + 0.7 * std::sqrt(inside))).cwiseMin(255.0);
  }
  return {colour};
}

Versions error_overlay(const Vector3d& rendered, const cv::Vec3b& sensor) {
  const Vector3d seen(sensor[0], sensor[1], sensor[2]);
  const double weight = std::min((rendered - seen).cwiseAbs().sum() / 3 / 255 / glsl::FULL_ERROR, 1.0);
  const double grey = 0.4 * seen.dot(Vector3d(0.299, 0.587, 0.114));
  return over(palette(weight, cv::COLORMAP_INFERNO), weight, Vector3d::Constant(grey / 255));
}

/// One pixel of a mode that blends.
Versions blended(const Images& images, std::size_t i, const ViewSettings& settings, const cv::Mat& sensor) {
  const double opacity = images.opacity[i];
  const Vector3d background = settings.background.cast<double>();
  const Vector3d light(images.colour[3 * i], images.colour[3 * i + 1], images.colour[3 * i + 2]);
  const Vector3d colour = 255 * (light + (1 - opacity) * background).cwiseMin(1.0);
  const auto depth = [&](double z) {
    return palette((z - settings.depth_near) / (settings.depth_far - settings.depth_near),
                   cv::COLORMAP_TURBO);
  };
  const auto error = [&](double squared) {
    return palette(std::sqrt(squared) / settings.error_far, cv::COLORMAP_INFERNO);
  };
  const cv::Vec3b seen = sensor.at<cv::Vec3b>(static_cast<int>(i));
  switch (settings.mode) {
    case ViewMode::Depth:
      return over(depth(images.depth_normalised[i]), opacity, background);
    case ViewMode::MedianDepth:
      return over(depth(images.depth_median[i]), images.depth_median[i] > 0, background);
    case ViewMode::Opacity:
      return {Vector3d::Constant(255 * opacity)};
    case ViewMode::Uncertainty:
      return error(images.uncertainty[i]);
    case ViewMode::GaussianUncertainty:
      return over(error(opacity > 0 ? light.x() / opacity : 0), opacity, background);
    case ViewMode::Sensor:
      return {Vector3d(seen[0], seen[1], seen[2])};
    case ViewMode::Error:
      return error_overlay(colour, seen);
    default:
      return {colour};
  }
}

Gaussians as_shown(const Scene& scene, ViewMode mode) {
  const Gaussians gaussians(scene.cloud);
  if (mode == ViewMode::Normals) return coloured(gaussians, normals(gaussians, scene.camera));
  if (mode != ViewMode::GaussianUncertainty) return gaussians;
  std::vector<Vector3d> colours;
  for (float u : scene.cloud.uncertainty) colours.push_back(Vector3d::Constant(u));
  return coloured(gaussians, colours);
}

}  // namespace

Picture paint(const Scene& scene, const ViewSettings& view, const cv::Mat& sensor) {
  ViewSettings settings = view;  // with the background of the pixel at hand
  const Gaussians gaussians = as_shown(scene, settings.mode);
  const bool dots = settings.mode == ViewMode::Points;
  const bool solid = dots || settings.mode == ViewMode::Ellipsoids;
  const auto all = solid ? solids(gaussians, scene.camera, dots) : std::vector<Solid>{};
  const Images images = render(gaussians, scene.camera, scene.depth);
  Picture picture;
  for (std::size_t i = 0; i < images.opacity.size(); ++i) {
    const int u = static_cast<int>(i) % images.width, v = static_cast<int>(i) / images.width;
    uint8_t edge = 0;
    settings.background = view.background;
    const int side = static_cast<int>(view.checker);
    if (side > 0 && (u / side + v / side) % 2 == 1) settings.background.array() += glsl::CHECKER_CONTRAST;
    if (solid) {
      picture.pixels.push_back(nearest_solid(all, u, v, dots, settings.background.cast<double>(), edge));
    } else {
      edge = images.blend_edge[i] || (settings.mode == ViewMode::MedianDepth && images.median_edge[i]);
      picture.pixels.push_back(blended(images, i, settings, sensor));
      if (settings.mode == ViewMode::Uncertainty && !valid_depth(scene.depth[i]))
        picture.pixels.back() = {255 * settings.background.cast<double>()};
    }
    picture.edge.push_back(edge);
  }
  return picture;
}

}  // namespace surefield::reference
