#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace surefield {

/// Number of spherical-harmonics coefficients per channel at `degree` (0 to 3): 1, 4, 9, 16.
constexpr int sh_coefficients(int degree) {
  return (degree + 1) * (degree + 1);
}

/// A set of 3D Gaussians in host memory, as optimised (raw, before any activation). All arrays have one entry
/// per Gaussian. World frame, metres.
struct GaussianCloud {
  std::vector<Eigen::Vector3f> means;       ///< centre
  std::vector<Eigen::Vector3f> log_scales;  ///< ln of the standard deviation along each axis, in metres
  std::vector<Eigen::Vector4f> rotations;   ///< quaternion w, x, y, z; not necessarily of unit length
  std::vector<float> opacity_logits;        ///< opacity = 1 / (1 + exp(-logit))
  int sh_degree = 0;                        ///< 0 to 3
  /// Spherical harmonics, sh_coefficients(sh_degree) x RGB per Gaussian:
  /// sh[(i * sh_coefficients(sh_degree) + coefficient) * 3 + channel].
  std::vector<float> sh;
  /// Mean squared error of the depth where the Gaussian dominates, m^2 (paper eq. 13); 0 where not known.
  std::vector<float> uncertainty;
  /// Width in the world of a pixel of the view that saw it from nearest, metres; 0: not known. Closer up or
  /// in a finer image than that, a Gaussian is drawn with as much of its neighbours as it was seen with.
  std::vector<float> sampling;
  /// Position, in a run's list of keyframes, of the one that the Gaussian was born in: it follows when that
  /// one's pose is corrected. 0 in a map of which that is not known.
  std::vector<uint32_t> anchors;

  std::size_t size() const { return means.size(); }

  /// Whether every array has the length that size() and sh_degree ask for.
  bool is_consistent() const;

  /// Sets every array to `count` entries (new ones are zero; rotations become the identity).
  void resize(std::size_t count);
};

}  // namespace surefield
