#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/reference/finite_differences.h"
#include "tests/reference/projection.h"
#include "tests/reference/scenes.h"

using namespace surefield;
using namespace surefield::reference;

namespace {

Eigen::Vector2d pinhole(const Intrinsics& k, const Eigen::Vector3d& p) {
  return {k.fx * p.x() / p.z() + k.cx, k.fy * p.y() / p.z() + k.cy};
}

/// One Gaussian at (x, y, 2) seen from the origin by a 40 x 30 camera with f = 20 and its centre at (15, 10).
struct OffCentre {
  Gaussians gaussians;
  Camera camera;

  OffCentre(double x, double y) {
    camera.intrinsics = {40, 30, 20, 20, 15, 10};
    gaussians.means.emplace_back(x, y, 2);
    gaussians.log_scales.emplace_back(std::log(0.1), std::log(0.2), std::log(0.3));
    gaussians.rotations.emplace_back(1, 0, 0, 0);
    gaussians.opacity_logits.push_back(0);
    gaussians.sh.resize(3);
  }
};

}  // namespace

TEST_CASE("Sigma2 is Sigma through the derivative of the pinhole projection, plus the blur") {
  const Scene scene = random_scene(3, 20, {.kind = SceneKind::anisotropic});
  const Gaussians gaussians(scene.cloud);
  for (int i = 0; i < 20; ++i) {
    const Projection projection = project(gaussians, i, scene.camera, {});
    Eigen::Vector3d p = gaussians.means[i];
    Eigen::Matrix<double, 2, 3> jacobian;  // of the image position, with respect to the position in the world
    const auto image_position = [&] {
      return pinhole(scene.camera.intrinsics, scene.camera.world_to_camera * p);
    };
    for (int axis = 0; axis < 3; ++axis)
      jacobian.col(axis) = central_difference(image_position, p[axis], 1e-3);
    const Eigen::Vector4d& q = gaussians.rotations[i];
    const Eigen::Matrix3d rotation =
        Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
    const Eigen::Vector3d variances = (2 * gaussians.log_scales[i]).array().exp();
    const Eigen::Matrix3d sigma = rotation * variances.asDiagonal() * rotation.transpose();
    // 0.3 of the pixels that the Gaussian was seen with, or of these where they are wider in the world.
    const double width =
        projection.depth() / std::sqrt(scene.camera.intrinsics.fx * scene.camera.intrinsics.fy);
    const double wider = std::max(1.0, gaussians.sampling[i] / width);
    const Eigen::Matrix2d expected =
        jacobian * sigma * jacobian.transpose() + 0.3 * wider * wider * Eigen::Matrix2d::Identity();
    CHECK((projection.covariance - expected).norm() < 1e-8 * expected.norm());
    CHECK((projection.conic * projection.covariance - Eigen::Matrix2d::Identity()).norm() < 1e-10);
    CHECK((projection.mean - image_position()).norm() < 1e-12);
  }
}

TEST_CASE("tangents are clamped at 1.3 times those of the image border, on each side its own") {
  // x/z: -0.5 - 15 = -15.5 pixels, 39.5 - 15 = 24.5; y/z: -10.5, 19.5; over f = 20, times 1.3.
  const double limits[2][2] = {{-1.3 * 15.5 / 20, 1.3 * 24.5 / 20}, {-1.3 * 10.5 / 20, 1.3 * 19.5 / 20}};
  for (int axis = 0; axis < 2; ++axis) {
    for (int side = 0; side < 2; ++side) {
      const double limit = limits[axis][side];
      for (const double factor : {0.999, 1.001, 1.5}) {
        const double tangent = limit * factor;
        const OffCentre view(axis == 0 ? 2 * tangent : 0, axis == 1 ? 2 * tangent : 0);
        const Projection projection = project(view.gaussians, 0, view.camera, {});
        const bool clamped = factor > 1;
        CHECK(projection.decisions.tangent_clamp[axis] == (clamped ? (side == 0 ? -1 : 1) : 0));
        CHECK(projection.decisions.tangent_clamp[1 - axis] == 0);
        // J = (f/z along the axis, -f tangent/z along z), the Gaussian being axis-aligned.
        const double slope = 10 * (clamped ? limit : tangent);
        const double across = axis == 0 ? 0.1 : 0.2;
        const double variance = std::pow(10 * across, 2) + std::pow(slope * 0.3, 2) + 0.3;
        CHECK(projection.covariance(axis, axis) == doctest::Approx(variance).epsilon(1e-12));
        CHECK(projection.mean[axis] == doctest::Approx(20 * tangent + (axis == 0 ? 15 : 10)).epsilon(1e-12));
      }
    }
  }
}

TEST_CASE("the colour depends on the direction from the camera centre to the Gaussian") {
  const Scene scene = random_scene(5, 1, {.kind = SceneKind::anisotropic, .sh_degree = 1});
  Gaussians gaussians(scene.cloud);
  std::fill(gaussians.sh.begin(), gaussians.sh.end(), 0.0);
  gaussians.sh[1 * 3 + 0] = 0.5;  // red: -y
  gaussians.sh[2 * 3 + 1] = 0.5;  // green: z
  gaussians.sh[3 * 3 + 2] = 0.5;  // blue: -x
  const Eigen::Vector3d camera_centre = scene.camera.world_to_camera.inverse().translation();
  const Eigen::Vector3d direction = (gaussians.means[0] - camera_centre).normalized();
  const Eigen::Vector3d expected =
      0.5 * Eigen::Vector3d::Ones() +
      0.4886025119029199 * 0.5 * Eigen::Vector3d(-direction.y(), direction.z(), -direction.x());
  CHECK((project(gaussians, 0, scene.camera, {}).colour - expected).norm() < 1e-12);
}
