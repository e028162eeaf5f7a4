#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "engine/types/gaussian_cloud.h"

namespace surefield::test {

/// Gaussians whose values every format can hold.
inline GaussianCloud random_cloud(std::size_t count, int sh_degree) {
  std::mt19937 random(static_cast<unsigned>(7 + sh_degree));
  std::uniform_real_distribution<float> value(-1, 1);
  GaussianCloud cloud;
  cloud.sh_degree = sh_degree;
  cloud.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (float& x : cloud.means[i]) x = 10 * value(random);
    for (float& x : cloud.log_scales[i]) x = 7 * value(random) - 2;
    for (float& x : cloud.rotations[i]) x = 3 * value(random);
    cloud.opacity_logits[i] = 6 * value(random);
    cloud.uncertainty[i] = std::abs(value(random));
    cloud.sampling[i] = std::abs(value(random));
  }
  for (float& x : cloud.sh) x = 0.99f * value(random);
  return cloud;
}

/// The opacity of a logit.
inline float opacity(float logit) {
  return 1 / (1 + std::exp(-logit));
}

/// The shape of a Gaussian with axes of 1, 2 and 3: what its rotation means.
inline Eigen::Matrix3f shape(const Eigen::Vector4f& q) {
  const Eigen::Matrix3f r = Eigen::Quaternionf(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  return r * Eigen::Vector3f(1, 2, 3).asDiagonal() * r.transpose();
}

/// The largest differences between two clouds, attribute by attribute.
struct Differences {
  float mean = 0, log_scale = 0, shape = 0, opacity = 0, colour = 0, degree_1 = 0, above = 0;
};

/// Compares Gaussian by Gaussian; the clouds must be of the same size and SH degree.
inline Differences compare(const GaussianCloud& a, const GaussianCloud& b) {
  Differences d;
  const auto raise = [](float& largest, float value) { largest = std::max(largest, std::abs(value)); };
  const auto coefficients = static_cast<std::size_t>(sh_coefficients(a.sh_degree));
  for (std::size_t i = 0; i < a.size(); ++i) {
    raise(d.mean, (a.means[i] - b.means[i]).cwiseAbs().maxCoeff());
    raise(d.log_scale, (a.log_scales[i] - b.log_scales[i]).cwiseAbs().maxCoeff());
    raise(d.shape, (shape(a.rotations[i]) - shape(b.rotations[i])).norm());
    raise(d.opacity, opacity(a.opacity_logits[i]) - opacity(b.opacity_logits[i]));
    for (std::size_t k = 0; k < 3 * coefficients; ++k) {
      const std::size_t at = 3 * coefficients * i + k;
      raise(k < 3 ? d.colour : k < 12 ? d.degree_1 : d.above, a.sh[at] - b.sh[at]);
    }
  }
  return d;
}

}  // namespace surefield::test
