#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/reference/finite_differences.h"
#include "tests/reference/losses.h"

using namespace surefield::reference;

namespace {

constexpr int width = 17, height = 13;

std::vector<double> random_image(uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> image(width * height * 3);
  for (double& value : image) value = uniform(random);
  return image;
}

/// A value of one channel; 0 outside the image.
double value_at(const std::vector<double>& image, int x, int y, int channel) {
  return x < 0 || y < 0 || x >= width || y >= height ? 0 : image[(y * width + x) * 3 + channel];
}

/// SSIM of one pixel by one sum over the two-dimensional window, from centred moments.
double direct_ssim(const std::vector<double>& a, const std::vector<double>& b, int x, int y, int channel) {
  double norm = 0, mean_a = 0, mean_b = 0, variance_a = 0, variance_b = 0, covariance = 0;
  const auto weight = [](int i, int j) { return std::exp(-(i * i + j * j) / 4.5); };
  for (int pass = 0; pass < 2; ++pass) {
    for (int j = -5; j <= 5; ++j) {
      for (int i = -5; i <= 5; ++i) {
        const double p = value_at(a, x + i, y + j, channel), q = value_at(b, x + i, y + j, channel);
        if (pass == 0) {
          norm += weight(i, j);
          mean_a += weight(i, j) * p;
          mean_b += weight(i, j) * q;
        } else {
          variance_a += weight(i, j) / norm * (p - mean_a) * (p - mean_a);
          variance_b += weight(i, j) / norm * (q - mean_b) * (q - mean_b);
          covariance += weight(i, j) / norm * (p - mean_a) * (q - mean_b);
        }
      }
    }
    if (pass == 0) {
      mean_a /= norm;
      mean_b /= norm;
    }
  }
  return (2 * mean_a * mean_b + 1e-4) * (2 * covariance + 9e-4) /
         ((mean_a * mean_a + mean_b * mean_b + 1e-4) * (variance_a + variance_b + 9e-4));
}

}  // namespace

TEST_CASE("an image has SSIM 1 with itself, and that is a maximum") {
  const std::vector<double> image = random_image(1);
  const Ssim result = ssim(width, height, image, image);
  CHECK(result.value == doctest::Approx(1).epsilon(1e-12));
  for (const double gradient : result.gradient) CHECK(std::abs(gradient) < 1e-12);
}

TEST_CASE("SSIM agrees with a direct computation over the two-dimensional window") {
  const std::vector<double> a = random_image(1), b = random_image(2);
  double sum = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int channel = 0; channel < 3; ++channel) sum += direct_ssim(a, b, x, y, channel);
    }
  }
  CHECK(ssim(width, height, a, b).value == doctest::Approx(sum / (width * height * 3)).epsilon(1e-12));
}

TEST_CASE("the SSIM gradient agrees with finite differences") {
  std::vector<double> a = random_image(3);
  const std::vector<double> b = random_image(4);
  const Ssim result = ssim(width, height, a, b);
  for (std::size_t i = 0; i < a.size(); i += 7) {
    const double expected = central_difference([&] { return ssim(width, height, a, b).value; }, a[i], 1e-3);
    CHECK(std::abs(result.gradient[i] - expected) < 1e-10 + 1e-7 * std::abs(expected));
  }
}
