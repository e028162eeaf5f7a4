#include <array>
#include <cmath>
#include <stdexcept>

#include "tests/reference/losses.h"

namespace surefield::reference {

namespace {

constexpr int radius = 5;
constexpr double sigma = 1.5;
constexpr double c1 = 0.01 * 0.01;
constexpr double c2 = 0.03 * 0.03;

using Plane = std::vector<double>;  // one channel, row-major

/// The Gaussian window along one axis; sums to 1.
std::array<double, 2 * radius + 1> window() {
  std::array<double, 2 * radius + 1> weights{};
  double sum = 0;
  for (int i = -radius; i <= radius; ++i) sum += weights[i + radius] = std::exp(-i * i / (2 * sigma * sigma));
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// One axis of the window's convolution, zero outside the image; dx, dy is the direction.
Plane filter_axis(const Plane& plane, int width, int height, int dx, int dy) {
  const auto weights = window();
  Plane result(plane.size());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int i = -radius; i <= radius; ++i) {
        const int u = x + i * dx, v = y + i * dy;
        if (u >= 0 && u < width && v >= 0 && v < height)
          result[y * width + x] += weights[i + radius] * plane[v * width + u];
      }
    }
  }
  return result;
}

/// The window's convolution. The window is symmetric, so that this is its own adjoint as well.
Plane filter(const Plane& plane, int width, int height) {
  return filter_axis(filter_axis(plane, width, height, 1, 0), width, height, 0, 1);
}

Plane product(const Plane& a, const Plane& b) {
  Plane result(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) result[i] = a[i] * b[i];
  return result;
}

/// A channel of an image, 0 where `mask` is.
Plane channel_of(std::span<const double> image, int channel, int channels, const Plane& mask) {
  Plane plane(mask.size());
  for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = mask[i] * image[i * channels + channel];
  return plane;
}

/// The sum of one channel's SSIM map over `mask`, and its derivative with respect to the first image, both of
/// which are 0 outside of it.
double ssim_sum(const Plane& first, const Plane& second, const Plane& mask, int width, int height,
                Plane& gradient) {
  const Plane mean1 = filter(first, width, height), mean2 = filter(second, width, height);
  const Plane square1 = filter(product(first, first), width, height);
  const Plane square2 = filter(product(second, second), width, height);
  const Plane cross = filter(product(first, second), width, height);

  double sum = 0;
  Plane g_mean1(first.size()), g_square1(first.size()), g_cross(first.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    const double m1 = mean1[i], m2 = mean2[i];
    const double a = 2 * m1 * m2 + c1, b = 2 * (cross[i] - m1 * m2) + c2;
    const double c = m1 * m1 + m2 * m2 + c1, d = square1[i] - m1 * m1 + square2[i] - m2 * m2 + c2;
    const double value = a * b / (c * d);
    sum += mask[i] * value;
    g_mean1[i] = mask[i] * (2 * m2 * (b - a) / (c * d) - 2 * m1 * value / c + 2 * m1 * value / d);
    g_square1[i] = -mask[i] * value / d;
    g_cross[i] = mask[i] * 2 * a / (c * d);
  }
  const Plane through_mean = filter(g_mean1, width, height),
              through_square = filter(g_square1, width, height);
  const Plane through_cross = filter(g_cross, width, height);
  gradient.resize(first.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    gradient[i] =
        mask[i] * (through_mean[i] + 2 * first[i] * through_square[i] + second[i] * through_cross[i]);
  }
  return sum;
}

}  // namespace

Ssim ssim(int width, int height, std::span<const double> first, std::span<const double> second,
          std::span<const uint8_t> mask, int channels) {
  if (first.size() != static_cast<std::size_t>(width) * height * channels || second.size() != first.size()) {
    throw std::invalid_argument("ssim: image sizes differ");
  }
  Ssim result;
  result.gradient.resize(first.size());
  Plane takes_part(static_cast<std::size_t>(width) * height, 1);
  for (std::size_t i = 0; i < mask.size(); ++i) takes_part[i] = mask[i];
  double count = 0;
  for (double part : takes_part) count += channels * part;
  if (count == 0) {
    result.value = 1;
    return result;
  }
  for (int channel = 0; channel < channels; ++channel) {
    Plane gradient;
    result.value +=
        ssim_sum(channel_of(first, channel, channels, takes_part),
                 channel_of(second, channel, channels, takes_part), takes_part, width, height, gradient) /
        count;
    for (std::size_t i = 0; i < gradient.size(); ++i)
      result.gradient[i * channels + channel] = gradient[i] / count;
  }
  return result;
}

}  // namespace surefield::reference
