#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <random>

#include "tests/reference/blending.h"
#include "tests/reference/finite_differences.h"
#include "tests/reference/scenes.h"
#include "tests/reference/splatting.h"

using namespace surefield;
using namespace surefield::reference;

namespace {

constexpr double step = 2e-5;
constexpr int losses = 7;  // one loss per output, and one of all outputs
constexpr const char* loss_names[losses] = {"colour", "opacity",     "depth", "depth_normalised",
                                            "median", "uncertainty", "all"};
using Losses = Eigen::Array<double, losses, 1>;

std::vector<double>* outputs(ImageGradients& g, int i) {
  std::vector<double>* all[] = {&g.colour,           &g.opacity,      &g.depth,
                                &g.depth_normalised, &g.depth_median, &g.uncertainty};
  return all[i];
}

/// A scene in double precision with one random linear loss of the images per entry of loss_names.
struct Problem {
  Gaussians gaussians;
  Camera camera;
  std::vector<float> sensor_depth;
  Settings settings;
  Decisions decisions;
  std::vector<ImageGradients> upstream;

  explicit Problem(const Scene& scene)
      : gaussians(scene.cloud), camera(scene.camera), sensor_depth(scene.depth) {
    settings.background = {0.3, 0.9, 0.1};
    render(gaussians, camera, sensor_depth, settings, &decisions);
    std::mt19937 random(17);
    std::uniform_real_distribution<double> uniform(-1, 1);
    upstream.assign(losses, ImageGradients(camera.intrinsics.width, camera.intrinsics.height));
    for (int output = 0; output < losses - 1; ++output) {
      for (double& value : *outputs(upstream[output], output)) value = uniform(random);
      *outputs(upstream[losses - 1], output) = *outputs(upstream[output], output);
    }
  }

  Losses evaluate(const Images& images) const {
    const auto dot = [](const std::vector<double>& a, const std::vector<double>& b) {
      double sum = 0;
      for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
      return sum;
    };
    Losses result;
    for (int i = 0; i < losses; ++i) {
      const ImageGradients& u = upstream[i];
      result[i] = dot(u.colour, images.colour) + dot(u.opacity, images.opacity) + dot(u.depth, images.depth) +
                  dot(u.depth_normalised, images.depth_normalised) +
                  dot(u.depth_median, images.depth_median) + dot(u.uncertainty, images.uncertainty);
    }
    return result;
  }

  Losses replayed() const { return evaluate(replay(gaussians, camera, sensor_depth, decisions, settings)); }

  std::vector<Gradients> gradients(PoseTerms pose_terms) const {
    std::vector<Gradients> result;
    for (const ImageGradients& u : upstream) {
      result.push_back(backward(gaussians, camera, sensor_depth, u, settings, pose_terms));
    }
    return result;
  }
};

/// Compares gradients of every loss with respect to one number. `f` gives the losses, `gradient(i)` that of
/// loss i.
template <class Function, class Gradient>
void check_derivative(const char* what, const Function& f, double& x, const Gradient& gradient) {
  const Losses expected = central_difference(f, x, step);
  for (int i = 0; i < losses; ++i) {
    const double error = std::abs(gradient(i) - expected[i]);
    if (error <= 1e-7 * std::abs(expected[i]) + 1e-7) continue;
    FAIL_CHECK(what << ", loss " << loss_names[i] << ": " << gradient(i) << " instead of " << expected[i]);
  }
}

void check_parameters(Problem& problem, const std::vector<Gradients>& gradients) {
  Gaussians& g = problem.gaussians;
  const auto f = [&] { return problem.replayed(); };
  for (std::size_t n = 0; n < g.size(); ++n) {
    for (int k = 0; k < 3; ++k) {
      check_derivative("mean", f, g.means[n][k], [&](int i) { return gradients[i].means[n][k]; });
      check_derivative("log-scale", f, g.log_scales[n][k],
                       [&](int i) { return gradients[i].log_scales[n][k]; });
    }
    for (int k = 0; k < 4; ++k) {
      check_derivative("rotation", f, g.rotations[n][k], [&](int i) { return gradients[i].rotations[n][k]; });
    }
    check_derivative("opacity", f, g.opacity_logits[n],
                     [&](int i) { return gradients[i].opacity_logits[n]; });
  }
  for (std::size_t n = 0; n < g.sh.size(); ++n) {
    check_derivative("sh", f, g.sh[n], [&](int i) { return gradients[i].sh[n]; });
  }
}

Eigen::Matrix3d exponential(const Eigen::Vector3d& phi) {
  if (phi.isZero(0)) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(phi.norm(), phi.normalized()).toRotationMatrix();
}

/// Compares the pose gradients with differences of `f`, which gives the losses at the problem's camera.
template <class Function>
void check_pose(Problem& problem, const std::vector<Gradients>& gradients, const Function& f) {
  const Pose centre = problem.camera.world_to_camera;
  Eigen::Vector3d phi = Eigen::Vector3d::Zero(), translation = Eigen::Vector3d::Zero();
  const auto moved = [&] {
    problem.camera.world_to_camera.linear() = exponential(phi) * centre.linear();
    problem.camera.world_to_camera.translation() = centre.translation() + translation;
    return f();
  };
  for (int k = 0; k < 3; ++k) {
    check_derivative("pose rotation", moved, phi[k], [&](int i) { return gradients[i].pose_rotation[k]; });
    check_derivative("pose translation", moved, translation[k],
                     [&](int i) { return gradients[i].pose_translation[k]; });
  }
  problem.camera.world_to_camera = centre;
}

std::vector<Projection> project_all(const Problem& problem) {
  std::vector<Projection> projections;
  for (std::size_t i = 0; i < problem.gaussians.size(); ++i) {
    projections.push_back(project(problem.gaussians, static_cast<int>(i), problem.camera, problem.settings,
                                  &problem.decisions.gaussians[i]));
  }
  return projections;
}

/// The losses from projected Gaussians, with the problem's discrete decisions.
Losses blended(const Problem& problem, const std::vector<Projection>& projections) {
  Images images(problem.camera.intrinsics.width, problem.camera.intrinsics.height);
  for (int y = 0; y < images.height; ++y) {
    for (int x = 0; x < images.width; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * images.width + x;
      blend_pixel(projections, problem.decisions.pixels[pixel], problem.sensor_depth[pixel], problem.settings,
                  x, y, images);
    }
  }
  return problem.evaluate(images);
}

Scene small_scene(uint32_t seed, SceneKind kind, int sh_degree) {
  return random_scene(seed, 12, {.kind = kind, .sh_degree = sh_degree, .width = 16, .height = 12});
}

/// What happens in the pixels of a problem: a test of a rare case has to contain it.
struct Census {
  int contributions = 0, saturated = 0, medians = 0, clamped_tangents = 0, clamped_colours = 0, culled = 0;

  explicit Census(const Problem& problem) {
    std::vector<bool> seen(problem.gaussians.size());
    for (const PixelDecisions& pixel : problem.decisions.pixels) {
      medians += pixel.median >= 0;
      for (const Contribution& contribution : pixel.contributions) {
        ++contributions;
        saturated += contribution.saturated;
        seen[contribution.gaussian] = true;
      }
    }
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const GaussianDecisions& d = problem.decisions.gaussians[i];
      culled += d.culled;
      if (!seen[i]) continue;
      clamped_tangents += d.tangent_clamp[0] != 0 || d.tangent_clamp[1] != 0;
      clamped_colours += std::count(d.colour_clamped.begin(), d.colour_clamped.end(), true) > 0;
    }
  }
};

}  // namespace

TEST_CASE(
    "gradients of every parameter and the pose agree with finite differences, for every kind of scene") {
  Census total(Problem(small_scene(0, SceneKind::mixed, 0)));
  for (const SceneKind kind : all_scene_kinds) {
    for (const uint32_t seed : {1u, 2u}) {
      CAPTURE(static_cast<int>(kind));
      CAPTURE(seed);
      Problem problem(small_scene(seed, kind, 0));
      const std::vector<Gradients> gradients = problem.gradients(PoseTerms::full);
      check_parameters(problem, gradients);
      check_pose(problem, gradients, [&] { return problem.replayed(); });
      const Census census(problem);
      CHECK(census.contributions > 0);
      total.saturated += census.saturated;
      total.medians += census.medians;
      total.clamped_tangents += census.clamped_tangents;
      total.clamped_colours += census.clamped_colours;
      total.culled += census.culled;
    }
  }
  CHECK(total.saturated > 20);
  CHECK(total.medians > 100);
  CHECK(total.clamped_tangents > 3);
  CHECK(total.clamped_colours > 5);
  CHECK(total.culled > 5);
}

TEST_CASE("gradients agree with finite differences where the depth is that of the centre") {
  Problem problem(small_scene(8, SceneKind::anisotropic, 0));
  problem.settings.plane_depth = false;
  const std::vector<Gradients> gradients = problem.gradients(PoseTerms::full);
  check_parameters(problem, gradients);
  check_pose(problem, gradients, [&] { return problem.replayed(); });
}

TEST_CASE("gradients agree with finite differences for every SH degree") {
  for (int degree = 0; degree <= 3; ++degree) {
    CAPTURE(degree);
    Problem problem(small_scene(7, SceneKind::mixed, degree));
    const std::vector<Gradients> gradients = problem.gradients(PoseTerms::full);
    check_parameters(problem, gradients);
    check_pose(problem, gradients, [&] { return problem.replayed(); });
  }
}

TEST_CASE("the light pose gradient holds the projected covariance and the colour") {
  for (const SceneKind kind : {SceneKind::anisotropic, SceneKind::at_border, SceneKind::mixed}) {
    Problem problem(small_scene(4, kind, 2));
    const std::vector<Projection> centre = project_all(problem);
    const std::vector<Gradients> light = problem.gradients(PoseTerms::light);
    check_pose(problem, light, [&] {
      std::vector<Projection> projections = centre;
      const std::vector<Projection> moved = project_all(problem);
      for (std::size_t i = 0; i < moved.size(); ++i) {
        projections[i].camera_mean = moved[i].camera_mean;
        projections[i].mean = moved[i].mean;
      }
      return blended(problem, projections);
    });
    check_parameters(problem, light);  // the Gaussians' gradients have all terms nevertheless
    CHECK((light.back().pose_rotation - problem.gradients(PoseTerms::full).back().pose_rotation).norm() >
          1e-3);
  }
}

TEST_CASE("gradients of the projected Gaussians agree with finite differences") {
  for (const SceneKind kind : {SceneKind::anisotropic, SceneKind::high_opacity, SceneKind::mixed}) {
    Problem problem(small_scene(9, kind, 0));
    std::vector<Projection> projections = project_all(problem);
    const std::vector<Gradients> gradients = problem.gradients(PoseTerms::full);
    const auto f = [&] { return blended(problem, projections); };
    for (std::size_t n = 0; n < projections.size(); ++n) {
      Projection& p = projections[n];
      const auto gradient = [&](int i) -> const ProjectionGradient& { return gradients[i].projections[n]; };
      for (int k = 0; k < 2; ++k) {
        check_derivative("2D mean", f, p.mean[k], [&](int i) { return gradient(i).mean[k]; });
      }
      for (int k = 0; k < 3; ++k) {
        check_derivative("colour", f, p.colour[k], [&](int i) { return gradient(i).colour[k]; });
      }
      check_derivative("o", f, p.opacity, [&](int i) { return gradient(i).opacity; });
      check_derivative("z", f, p.camera_mean.z(), [&](int i) { return gradient(i).depth; });
      for (int entry = 0; entry < 4; ++entry) {
        const int row = entry / 2, column = entry % 2;
        check_derivative("conic", f, p.conic(row, column),
                         [&](int i) { return gradient(i).conic(row, column); });
        if (problem.decisions.gaussians[n].culled) continue;
        const auto through_covariance = [&] {
          p.conic = p.covariance.inverse();
          return f();
        };
        check_derivative("Sigma2", through_covariance, p.covariance(row, column),
                         [&](int i) { return gradient(i).covariance(row, column); });
        p.conic = p.covariance.inverse();
      }
    }
  }
}

TEST_CASE("replaying the decisions at the centre gives what was rendered") {
  const Problem problem(small_scene(11, SceneKind::mixed, 3));
  const Images images = render(problem.gaussians, problem.camera, problem.sensor_depth, problem.settings);
  const Images again =
      replay(problem.gaussians, problem.camera, problem.sensor_depth, problem.decisions, problem.settings);
  CHECK(images.colour == again.colour);
  CHECK(images.opacity == again.opacity);
  CHECK(images.depth == again.depth);
  CHECK(images.depth_normalised == again.depth_normalised);
  CHECK(images.depth_median == again.depth_median);
  CHECK(images.uncertainty == again.uncertainty);
  CHECK(images.dominator == again.dominator);
  CHECK(images.dominator_weight == again.dominator_weight);
}
