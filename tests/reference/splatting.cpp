#include "tests/reference/splatting.h"

#include <stdexcept>

#include "tests/reference/blending.h"
#include "tests/reference/projection.h"

namespace surefield::reference {

namespace {

void require_depth_size(std::span<const float> sensor_depth, const Intrinsics& k) {
  if (!sensor_depth.empty() && sensor_depth.size() != static_cast<std::size_t>(k.width) * k.height) {
    throw std::invalid_argument("sensor depth is not of the camera's size");
  }
}

std::vector<Projection> project_all(const Gaussians& gaussians, const Camera& camera,
                                    const Settings& settings, const Decisions* held) {
  std::vector<Projection> projections;
  for (std::size_t i = 0; i < gaussians.size(); ++i) {
    projections.push_back(
        project(gaussians, static_cast<int>(i), camera, settings, held ? &held->gaussians[i] : nullptr));
  }
  return projections;
}

/// The sensor depth of one pixel; 0, which is invalid, where there is none.
float depth_at(std::span<const float> sensor_depth, std::size_t pixel) {
  return sensor_depth.empty() ? 0.0f : sensor_depth[pixel];
}

Decisions decide_all(const Gaussians& gaussians, const std::vector<Projection>& projections,
                     const Settings& settings, Images& images) {
  Decisions decisions;
  for (const Projection& projection : projections) {
    decisions.gaussians.push_back(projection.decisions);
    images.gaussian_edge.push_back(projection.gradient_edge);
  }
  const std::vector<int> order = depth_order(projections);
  for (int y = 0; y < images.height; ++y) {
    for (int x = 0; x < images.width; ++x) {
      decisions.pixels.push_back(decide_pixel(gaussians, projections, order, settings, x, y, images));
    }
  }
  return decisions;
}

void blend_all(const std::vector<Projection>& projections, const Decisions& decisions,
               std::span<const float> sensor_depth, const Settings& settings, Images& images) {
  for (int y = 0; y < images.height; ++y) {
    for (int x = 0; x < images.width; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * images.width + x;
      blend_pixel(projections, decisions.pixels[pixel], depth_at(sensor_depth, pixel), settings, x, y,
                  images);
    }
  }
}

Gradients zero_gradients(const Gaussians& gaussians) {
  Gradients gradients;
  gradients.means.resize(gaussians.size(), Eigen::Vector3d::Zero());
  gradients.log_scales.resize(gaussians.size(), Eigen::Vector3d::Zero());
  gradients.rotations.resize(gaussians.size(), Eigen::Vector4d::Zero());
  gradients.opacity_logits.resize(gaussians.size());
  gradients.sh.resize(gaussians.sh.size());
  gradients.projections.resize(gaussians.size());
  return gradients;
}

}  // namespace

Images render(const Gaussians& gaussians, const Camera& camera, std::span<const float> sensor_depth,
              const Settings& settings, Decisions* decisions) {
  require_depth_size(sensor_depth, camera.intrinsics);
  Images images(camera.intrinsics.width, camera.intrinsics.height);
  const std::vector<Projection> projections = project_all(gaussians, camera, settings, nullptr);
  Decisions taken = decide_all(gaussians, projections, settings, images);
  blend_all(projections, taken, sensor_depth, settings, images);
  if (decisions) *decisions = std::move(taken);
  return images;
}

Images replay(const Gaussians& gaussians, const Camera& camera, std::span<const float> sensor_depth,
              const Decisions& decisions, const Settings& settings) {
  require_depth_size(sensor_depth, camera.intrinsics);
  Images images(camera.intrinsics.width, camera.intrinsics.height);
  images.gaussian_edge.resize(gaussians.size());
  blend_all(project_all(gaussians, camera, settings, &decisions), decisions, sensor_depth, settings, images);
  return images;
}

Gradients backward(const Gaussians& gaussians, const Camera& camera, std::span<const float> sensor_depth,
                   const ImageGradients& upstream, const Settings& settings, PoseTerms pose_terms) {
  require_depth_size(sensor_depth, camera.intrinsics);
  Images images(camera.intrinsics.width, camera.intrinsics.height);
  const std::vector<Projection> projections = project_all(gaussians, camera, settings, nullptr);
  const Decisions decisions = decide_all(gaussians, projections, settings, images);
  Gradients gradients = zero_gradients(gaussians);
  for (int y = 0; y < images.height; ++y) {
    for (int x = 0; x < images.width; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * images.width + x;
      blend_pixel_backward(projections, decisions.pixels[pixel], depth_at(sensor_depth, pixel), settings, x,
                           y, upstream, gradients.projections);
    }
  }
  for (std::size_t i = 0; i < gaussians.size(); ++i) {
    if (projections[i].decisions.culled) continue;
    ProjectionGradient& gradient = gradients.projections[i];
    gradient.covariance = -projections[i].conic * gradient.conic * projections[i].conic;
    project_backward(gaussians, static_cast<int>(i), camera, settings, projections[i], gradient, pose_terms,
                     gradients);
  }
  return gradients;
}

}  // namespace surefield::reference
