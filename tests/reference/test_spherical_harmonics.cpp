#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/reference/finite_differences.h"
#include "tests/reference/spherical_harmonics.h"

using namespace surefield::reference;

namespace {

const Eigen::Vector3d directions[] = {{1, 2, -2}, {-3, 1, 4}, {-1, -5, 2}, {0.3, -0.1, -0.8}};

/// The real spherical harmonic of degree l and order m with the Condon-Shortley phase, from Legendre
/// functions.
double textbook_harmonic(int l, int m, const Eigen::Vector3d& d) {
  const int order = std::abs(m);
  double factorials = 1;  // (l - |m|)! / (l + |m|)!
  for (int k = l - order + 1; k <= l + order; ++k) factorials /= k;
  const double norm = std::sqrt((2 * l + 1) / (4 * std::numbers::pi) * factorials);
  const double legendre = std::assoc_legendre(static_cast<unsigned>(l), static_cast<unsigned>(order), d.z());
  const double phi = std::atan2(d.y(), d.x());
  if (m == 0) return norm * legendre;
  const double phase = order % 2 == 0 ? 1 : -1;
  return phase * std::numbers::sqrt2 * norm * legendre *
         (m < 0 ? std::sin(order * phi) : std::cos(order * phi));
}

}  // namespace

TEST_CASE("the SH basis is that of textbooks, orders -l to l") {
  for (const Eigen::Vector3d& vector : directions) {
    const Eigen::Vector3d d = vector.normalized();
    const auto basis = sh_basis(d);
    for (int l = 0, coefficient = 0; l <= 3; ++l) {
      for (int m = -l; m <= l; ++m, ++coefficient) {
        CAPTURE(coefficient);
        CHECK(basis[coefficient] == doctest::Approx(textbook_harmonic(l, m, d)).epsilon(1e-10));
      }
    }
  }
}

TEST_CASE("the SH basis gradient is its derivative") {
  for (const Eigen::Vector3d& vector : directions) {
    Eigen::Vector3d d = vector.normalized();
    const auto gradient = sh_basis_gradient(d);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Matrix<double, 16, 1> difference =
          central_difference([&] { return sh_basis(d); }, d[axis], 1e-3);
      CHECK((gradient.col(axis) - difference).norm() < 1e-11);
    }
  }
}
