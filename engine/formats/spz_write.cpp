#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "engine/formats/gaussian_order.h"
#include "engine/formats/gzip.h"
#include "engine/formats/rounded_values.h"
#include "engine/formats/spz.h"
#include "engine/formats/spz_layout.h"
#include "engine/formats/turned_axes.h"
#include "engine/io/files.h"
#include "engine/types/error.h"

static_assert(std::endian::native == std::endian::little,
              "SPZ files are written in the byte order of the machine");

namespace surefield {

namespace {

using Bytes = std::vector<uint8_t>;

constexpr int kUsualFractionalBits = 12;
constexpr float kLargestCoordinate = (1 << 23) - 1;
constexpr float kSteps1 = 8,
                kStepsAbove = 16;  // SH bytes are multiples of these: 5 bits for degree 1, 4 above

/// The bits after the point: the usual number, or fewer where a coordinate would not fit.
int fractional_bits(const std::filesystem::path& file, const GaussianCloud& cloud) {
  float largest = 0;
  for (const Eigen::Vector3f& mean : cloud.means)
    if (mean.allFinite()) largest = std::max(largest, mean.cwiseAbs().maxCoeff());
  int bits = kUsualFractionalBits;
  while (bits > 0 && largest * static_cast<float>(1 << bits) > kLargestCoordinate) --bits;
  if (largest > kLargestCoordinate)
    throw InputError(file, "cannot be written: SPZ holds positions up to 8388 km; use the PLY format");
  return bits;
}

Bytes positions(const GaussianCloud& cloud, int bits) {
  Bytes bytes;
  for (const Eigen::Vector3f& mean : cloud.means)
    for (int axis = 0; axis < 3; ++axis) {
      const float steps = mean[axis] * kTurnedAxes[axis] * static_cast<float>(1 << bits);
      const auto fixed = static_cast<uint32_t>(std::isfinite(steps) ? std::lround(steps) : 0);
      for (int shift : {0, 8, 16}) bytes.push_back(static_cast<uint8_t>(fixed >> shift));
    }
  return bytes;
}

/// Gaussians that are not finite, which the format cannot hold, become invisible.
Bytes opacities(const GaussianCloud& cloud) {
  Bytes bytes;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    bytes.push_back(is_finite(cloud, i) ? to_byte(255 * opacity_of(cloud.opacity_logits[i])) : uint8_t{0});
  return bytes;
}

Bytes colours(const GaussianCloud& cloud) {
  const auto stride = static_cast<std::size_t>(sh_coefficients(cloud.sh_degree)) * 3;
  Bytes bytes;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    for (std::size_t channel = 0; channel < 3; ++channel)
      bytes.push_back(to_byte(255 * (spz::kColourScale * cloud.sh[i * stride + channel] + 0.5f)));
  return bytes;
}

Bytes scales(const GaussianCloud& cloud) {
  Bytes bytes;
  for (const Eigen::Vector3f& log_scale : cloud.log_scales)
    for (float value : log_scale) bytes.push_back(to_byte(spz::kScaleSteps * (value + spz::kScaleOffset)));
  return bytes;
}

/// A rotation w, x, y, z that gives the same Gaussian, with the largest component first and positive. Turning
/// a Gaussian about one of its own axes by 180 degrees changes nothing but the order and the signs of the
/// components. The file has no w, and from x, y and z alone a small one could not be told.
Eigen::Vector4f with_large_w(const Eigen::Vector4f& rotation) {
  const Eigen::Vector4f q = rotation.normalized();
  Eigen::Index largest = 0;
  q.cwiseAbs().maxCoeff(&largest);
  const float w = q[0], x = q[1], y = q[2], z = q[3];
  const std::array<Eigen::Vector4f, 4> turned = {
      q, Eigen::Vector4f(-x, w, z, -y), Eigen::Vector4f(-y, -z, w, x), Eigen::Vector4f(-z, y, -x, w)};
  const Eigen::Vector4f& best = turned[static_cast<std::size_t>(largest)];
  return best[0] < 0 ? Eigen::Vector4f(-best) : best;
}

Bytes rotations(const GaussianCloud& cloud) {
  Bytes bytes;
  for (const Eigen::Vector4f& rotation : cloud.rotations) {
    const Eigen::Vector4f q = with_large_w(rotation);
    for (int axis = 0; axis < 3; ++axis)
      bytes.push_back(to_byte(127.5f * (q[axis + 1] * kTurnedAxes[axis] + 1)));
  }
  return bytes;
}

Bytes harmonics(const GaussianCloud& cloud) {
  const auto coefficients = static_cast<std::size_t>(sh_coefficients(cloud.sh_degree));
  Bytes bytes;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    for (std::size_t k = 1; k < coefficients; ++k)
      for (std::size_t channel = 0; channel < 3; ++channel) {
        const float value = cloud.sh[(i * coefficients + k) * 3 + channel] * kTurnedHarmonics[k - 1];
        const float step = k < 4 ? kSteps1 : kStepsAbove;
        bytes.push_back(to_byte(std::round((128 * value + 128) / step) * step));
      }
  return bytes;
}

}  // namespace

void write_spz(std::ostream& stream, const std::filesystem::path& file, const GaussianCloud& cloud) {
  if (!cloud.is_consistent()) throw UsageError("write_spz: the arrays of the cloud differ in length");
  if (cloud.size() > std::numeric_limits<uint32_t>::max())
    throw InputError(file, "cannot be written: SPZ holds at most 4294967295 Gaussians");
  const spz::Header header{.count = static_cast<uint32_t>(cloud.size()),
                           .sh_degree = static_cast<uint8_t>(cloud.sh_degree),
                           .fractional_bits = static_cast<uint8_t>(fractional_bits(file, cloud))};
  Bytes start(sizeof(header));
  std::memcpy(start.data(), &header, sizeof(header));
  GzipWriter gzip(stream);
  gzip.write(start);
  gzip.write(positions(cloud, header.fractional_bits));
  gzip.write(opacities(cloud));
  gzip.write(colours(cloud));
  gzip.write(scales(cloud));
  gzip.write(rotations(cloud));
  gzip.write(harmonics(cloud));
  gzip.finish();
}

void write_spz(const std::filesystem::path& file, const GaussianCloud& cloud) {
  write_file(file, [&](std::ostream& stream) { write_spz(stream, file, cloud); });
}

}  // namespace surefield
